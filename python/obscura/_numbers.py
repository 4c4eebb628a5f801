"""Numbers that callers give, checked before anything is done with them.

SPDX-License-Identifier: Apache-2.0
"""

import numpy as np


def numbers_of(name, value, sizes):
    """Finite numbers: one where `sizes` is empty, else a list of one of these lengths."""
    expected = f"{' or '.join(map(str, sizes))} numbers" if sizes else "a number"
    try:
        numbers = np.asarray(value)
    except (TypeError, ValueError):
        raise TypeError(f"{name}: expected {expected}, not {value!r}") from None
    if numbers.dtype.kind not in "iuf" and numbers.size > 0:
        raise TypeError(f"{name}: expected {expected}, not {value!r}")
    if numbers.shape not in ([(size,) for size in sizes] if sizes else [()]):
        raise ValueError(f"{name}: expected {expected}, not {value!r}")
    if not np.isfinite(numbers).all():
        raise ValueError(f"{name}: expected finite numbers, not {value!r}")
    return numbers.astype(np.float64)
