"""Which hypotheses hold for which user: one user says little, all users together say more.

Users of a cell share surroundings, so their delay spreads lie about a common value: ln τ_k ~ N(m, s²), with m anywhere
on the grid and s one of ``SPREADS``, from "the same" to "anything". The pairs (m, s) are weighed by how well they
explain all users, and so are averaged over, not chosen. The kinds of profile have shares in the cell, found by
expectation and maximisation from equal ones.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray

SPREADS = np.array([0.05, 0.25, 0.7, 2.0])
ROUNDS = 4
FLOOR = 1e-12
SMALLEST, TOGETHER = 1e-19, 16
"""Less than any evidence, by the floor of the priors, and how many of its like may be multiplied."""
PSEUDO_USERS = 1.0
"""Users that stand for equal shares of the kinds."""


@kernel
def delay_priors(delays: int, log_step: float) -> FloatArray:
    """The distribution of a user's delay spread for each (m, s), shape (spread · delay, delay)."""
    priors, apart = np.empty((SPREADS.size * delays, delays)), np.empty(delays)
    for s in range(SPREADS.size):
        for t in range(delays):
            apart[t] = np.exp(-0.5 * (t * log_step / SPREADS[s]) ** 2) + FLOOR
        for m in range(delays):
            p, total = s * delays + m, 0.0
            for t in range(delays):
                total += apart[abs(t - m)]
            for t in range(delays):
                priors[p, t] = apart[abs(t - m)] / total
    return priors


@kernel
def log_evidence_of(evidence: FloatArray, log_prior: FloatArray) -> FloatArray:
    """Σ ln of the users' ``evidence`` (user, prior), ``SMALLEST`` to about 1, and ``log_prior`` (delay,); (prior,).

    Logarithms are taken of products, as many together as a number holds.
    """
    users, count = evidence.shape
    total, product = np.empty(count), np.empty(count)
    for p in range(count):
        total[p] = log_prior[p % log_prior.size]
    for first in range(0, users, TOGETHER):
        product[:] = 1.0
        for k in range(first, min(first + TOGETHER, users)):
            for p in range(count):
                product[p] *= evidence[k, p]
        total += np.log(product)
    return total


@kernel
def posterior_of_delays(
    likelihood: FloatArray, priors: FloatArray, across: FloatArray, log_prior: FloatArray
) -> FloatArray:
    """Factors that turn the likelihood (user, delay) into the pooled posterior, up to each user's total; same shape.

    ``across`` (delay, prior) holds the priors the other way round, ``log_prior`` (delay,) is that of m.
    """
    users, delays = likelihood.shape
    count = priors.shape[0]
    evidence = np.zeros((users, count))
    for k in range(users):
        for t in range(delays):
            own = likelihood[k, t]
            for p in range(count):
                evidence[k, p] += own * across[t, p]
    evidence = np.maximum(evidence, SMALLEST)
    log_evidence = log_evidence_of(evidence, log_prior)
    weight = np.exp(log_evidence - log_evidence.max())
    factor = np.zeros((users, delays))
    for p in range(count):
        if weight[p] > FLOOR:
            for k in range(users):
                scale = weight[p] / evidence[k, p]
                for t in range(delays):
                    factor[k, t] += scale * priors[p, t]
    return factor


@kernel
def pooled_weights(log_likelihood: FloatArray, families: int, log_step: float, log_prior: FloatArray) -> FloatArray:
    """The posterior probability of each hypothesis for each user, same shape (user, hypothesis).

    Args:
        log_likelihood: ln L, shape (user, families × delays); zeros for users without observation.
        families: kinds of profile.
        log_step: ln of the ratio of neighbouring delay spreads.
        log_prior: of the delay about which the users' lie, shape (delay,).
    """
    users, count = log_likelihood.shape
    delays = count // families
    priors = delay_priors(delays, log_step)
    across = priors.T.copy()
    likelihood = np.empty((users, families, delays))
    for k in range(users):
        likelihood[k] = np.exp(log_likelihood[k] - log_likelihood[k].max()).reshape((families, delays))
    share, part = np.full(families, 1.0 / families), np.empty((users, families))
    weight = np.empty((users, families, delays))
    for _ in range(ROUNDS):
        mixed = np.zeros((users, delays))
        for k in range(users):
            for f in range(families):
                for t in range(delays):
                    mixed[k, t] += share[f] * likelihood[k, f, t]
        factor = posterior_of_delays(mixed, priors, across, log_prior)
        found = np.full(families, PSEUDO_USERS / families)
        for k in range(users):
            for f in range(families):
                for t in range(delays):
                    weight[k, f, t] = share[f] * likelihood[k, f, t] * factor[k, t]
                part[k, f] = weight[k, f].sum()
            found += part[k] / part[k].sum()
        share = found / found.sum()
    for k in range(users):
        weight[k] /= part[k].sum()
    return weight.reshape((users, count))
