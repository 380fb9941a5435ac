"""numpy that gives the same bits on every x86-64 processor: `from portable import np`.

A seal is a hash of bits, and a round must come out the same wherever it is made again. numpy's loops for AVX-512 round
sines and exponentials otherwise than all its others, and a threaded BLAS sums in another order: neither may be used.
Both are chosen when numpy is loaded.
"""

import os
import sys

SAME_BITS = {"NPY_DISABLE_CPU_FEATURES": "AVX512_SKX", "OPENBLAS_NUM_THREADS": "1"}
if "numpy" in sys.modules and any(os.environ.get(k) != v for k, v in SAME_BITS.items()):
    raise ImportError("portable: numpy was imported before")
os.environ.update(SAME_BITS)

import numpy as np  # noqa: E402, F401
