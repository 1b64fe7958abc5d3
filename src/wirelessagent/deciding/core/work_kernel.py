"""Where a search ends that runs out of time: every loop that may take long counts its steps, and asks here each time.

The clock is read by nobody in a kernel. It sets a flag (:mod:`.time_limit`), and the number of steps done until the
flag was seen says where the search ended: counted to that number it ends at the same place again, on any machine.
"""

from __future__ import annotations

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import IntArray

DONE, MOST, STOP = 0, 1, 2
"""Places of ``work``: the steps done, the most to do, and whether to stop at once (1)."""


@kernel
def is_over(work: IntArray) -> bool:
    """Whether the search has to end; if not, one more step is counted."""
    if work[STOP] != 0 or work[DONE] >= work[MOST]:
        return True
    work[DONE] += 1
    return False
