"""Passes of gradient steps: over sentences, for a multinomial logistic regression, and over the lines of talks.

A step is −s g/√(Σ g²), summed over all steps before (AdaGrad, Duchi et al. 2011).

Of a sentence the buckets are ``columns[starts[i]] … columns[starts[i + 1]]`` with their ``values``; ``right`` marks the
labels that are meant, of which one is enough.

Of a line the changes lie at ``changes_at[line] … changes_at[line + 1]``, its blocks likewise; of a change ``own`` are
the buckets of its signs and ``has`` its blocks by their place in the line, of a block ``blocks`` are its buckets. It
scores o Σ w(own) + Σ over its blocks of b Σ w(block)/√(its buckets). What a line may mean lies at ``counts[line] …``:
the places of changes together, and the signs of those. The likelihood of a line is that of what is ``right``, under a
softmax.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from wirelessagent.kernels import kernel

Places: TypeAlias = np.ndarray[tuple[int, ...], np.dtype[np.int32 | np.int64]]
Marks: TypeAlias = np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
Floats: TypeAlias = np.ndarray[tuple[int, ...], np.dtype[np.float32]]


@kernel
def one_pass(
    order: Places, starts: Places, columns: Places, values: Floats, right: Marks, importance: Floats, weights: Floats,
    squares: Floats, step: float,
) -> float:  # fmt: skip
    """Step along each sentence in ``order``, and say how much likelihood they lack in all.

    The last row of ``weights`` (bucket, label) and of ``squares`` is that of the intercepts.
    """
    classes, last = weights.shape[1], weights.shape[0] - 1
    likely, slope, lost = np.zeros(classes, np.float32), np.zeros(classes, np.float32), 0.0
    for i in order:
        for c in range(classes):
            likely[c] = weights[last, c]
        for at in range(starts[i], starts[i + 1]):
            for c in range(classes):
                likely[c] += values[at] * weights[columns[at], c]
        most, total, meant = likely.max(), np.float32(0.0), np.float32(0.0)
        for c in range(classes):
            likely[c] = np.exp(likely[c] - most)
            total += likely[c]
            if right[i, c]:
                meant += likely[c]
        meant = max(meant, np.float32(1e-30))
        lost -= importance[i] * np.log(meant / total)
        for c in range(classes):
            share = likely[c] / meant if right[i, c] else np.float32(0.0)
            slope[c] = importance[i] * (likely[c] / total - share)
            squares[last, c] += slope[c] * slope[c]
            weights[last, c] -= step * slope[c] / np.sqrt(squares[last, c])
        for at in range(starts[i], starts[i + 1]):
            row, value = columns[at], values[at]
            for c in range(classes):
                down = slope[c] * value
                squares[row, c] += down * down
                weights[row, c] -= step * down / np.sqrt(squares[row, c])
    return lost


@kernel
def scores_of(
    line: int, changes_at: Places, own: Places, own_at: Places, blocks_at: Places, blocks: Places, block_at: Places,
    has: Places, has_at: Places, of_own: float, of_block: float, weights: Floats,
) -> Floats:  # fmt: skip
    """The score of each change of a line."""
    first_block, first = blocks_at[line], changes_at[line]
    sums = np.zeros(blocks_at[line + 1] - first_block, np.float32)
    for block in range(len(sums)):
        begin, end = block_at[first_block + block], block_at[first_block + block + 1]
        for place in range(begin, end):
            sums[block] += weights[blocks[place]]
        sums[block] *= of_block / np.sqrt(max(end - begin, 1))
    scores = np.zeros(changes_at[line + 1] - first, np.float32)
    for change in range(len(scores)):
        for place in range(own_at[first + change], own_at[first + change + 1]):
            scores[change] += weights[own[place]]
        scores[change] *= of_own
        for place in range(has_at[first + change], has_at[first + change + 1]):
            scores[change] += sums[has[place]]
    return scores


@kernel
def likelihoods(
    begin: int, end: int, places: Places, places_at: Places, signs: Places, signs_at: Places, scores: Floats,
    joint: Floats,
) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:  # fmt: skip
    """How likely each of the meanings from ``begin`` to ``end`` is, by its changes and by what they are together."""
    likely = np.zeros(end - begin)
    for meaning in range(begin, end):
        for place in range(places_at[meaning], places_at[meaning + 1]):
            likely[meaning - begin] += scores[places[place]]
        for place in range(signs_at[meaning], signs_at[meaning + 1]):
            likely[meaning - begin] += joint[signs[place]]
    likely = np.exp(likely - likely.max())
    return likely / likely.sum()


@kernel
def descend(touched: Places, many: int, slopes: Floats, weights: Floats, squares: Floats, step: float) -> None:
    """A step of the first ``many`` weights that are touched; their slopes are zero then."""
    for place in range(many):
        bucket = touched[place]
        if slopes[bucket] != 0:
            squares[bucket] += slopes[bucket] ** 2
            weights[bucket] -= step * slopes[bucket] / np.sqrt(squares[bucket])
            slopes[bucket] = 0


@kernel
def one_pass_of_talks(
    order: Places, changes_at: Places, own: Places, own_at: Places, blocks_at: Places, blocks: Places,
    block_at: Places, has: Places, has_at: Places, of_own: float, of_block: float, counts: Places, places: Places,
    places_at: Places, signs: Places, signs_at: Places, right: Marks, weights: Floats, squares: Floats,
    joint: Floats, joint_squares: Floats, slopes: Floats, step: float,
) -> float:  # fmt: skip
    """One pass over lines in an order, with a step behind each; the sum of their losses. ``slopes`` is scratch."""
    loss = 0.0
    touched = np.zeros(len(weights), np.int64)
    for line in order:
        first_block, first = blocks_at[line], changes_at[line]
        scores = scores_of(
            line, changes_at, own, own_at, blocks_at, blocks, block_at, has, has_at, of_own, of_block, weights
        )
        begin, end = int(counts[line]), int(counts[line + 1])
        likely = likelihoods(begin, end, places, places_at, signs, signs_at, scores, joint)
        share = 1e-30
        for meaning in range(begin, end):
            if right[meaning]:
                share += likely[meaning - begin]
        loss -= np.log(share)
        of_changes = np.zeros(len(scores))
        of_blocks = np.zeros(blocks_at[line + 1] - first_block)
        of_signs = np.zeros(len(joint))
        for meaning in range(begin, end):
            down = likely[meaning - begin] * (1.0 - 1.0 / share if right[meaning] else 1.0)
            for place in range(places_at[meaning], places_at[meaning + 1]):
                of_changes[places[place]] += down
            for place in range(signs_at[meaning], signs_at[meaning + 1]):
                of_signs[signs[place]] += down
        for sign in range(len(joint)):
            if of_signs[sign] != 0:
                joint_squares[sign] += of_signs[sign] ** 2
                joint[sign] -= step * of_signs[sign] / np.sqrt(joint_squares[sign])
        many = 0
        for change in range(len(scores)):
            down = of_changes[change]
            if abs(down) < 1e-7:
                continue
            for place in range(has_at[first + change], has_at[first + change + 1]):
                of_blocks[has[place]] += down
            for place in range(own_at[first + change], own_at[first + change + 1]):
                if slopes[own[place]] == 0:
                    touched[many] = own[place]
                    many += 1
                slopes[own[place]] += of_own * down
        for block in range(len(of_blocks)):
            begin, end = block_at[first_block + block], block_at[first_block + block + 1]
            down = of_block * of_blocks[block] / np.sqrt(max(end - begin, 1))
            if down == 0:
                continue
            for place in range(begin, end):
                if slopes[blocks[place]] == 0:
                    touched[many] = blocks[place]
                    many += 1
                slopes[blocks[place]] += down
        descend(touched, many, slopes, weights, squares, step)
    return loss
