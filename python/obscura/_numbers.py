"""Numbers that callers give, checked before anything is done with them.

SPDX-License-Identifier: Apache-2.0
"""

import numbers

import numpy as np


def numbers_of(name, value, sizes):
    """Finite numbers: one where `sizes` is empty, else a list of one of these lengths."""
    expected = f"{' or '.join(map(str, sizes))} numbers" if sizes else "a number"
    given = value
    if sizes:
        try:
            given = list(value)
        except TypeError:
            raise TypeError(f"{name}: expected {expected}, not {value!r}") from None
    for one in given if sizes else [given]:
        if not isinstance(one, numbers.Real) or isinstance(one, (bool, np.bool_)):
            raise TypeError(f"{name}: expected {expected}, not {value!r}")
    if sizes and len(given) not in sizes:
        raise ValueError(f"{name}: expected {expected}, not {value!r}")
    out = np.asarray(given, dtype=np.float64)
    if not np.isfinite(out).all():
        raise ValueError(f"{name}: expected finite numbers, not {value!r}")
    return out
