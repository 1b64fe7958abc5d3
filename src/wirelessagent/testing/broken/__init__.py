"""Deliberately broken plug-ins by kind. Each names in ``caught_by`` the one check that must reject it."""
