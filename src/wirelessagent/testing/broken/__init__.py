"""Deliberately broken plug-ins, one file per kind. Each names in ``caught_by`` the one check that must reject it."""
