"""Whether an interpreter can run the FMUs.

A module of its own in each FMU, which imports it before anything else.
"""

import sys
from importlib.util import find_spec

NEEDED = ("numpy", "scipy", "numba")


def prepare():
    """See that the packages are there, or raise ImportError with one sentence.

    pythonfmu hands it to the host's logger; it goes to stderr, too, because hosts may log nothing.
    """
    missing = [name for name in NEEDED if find_spec(name) is None]
    if missing:
        text = (
            f"this FMU needs {', '.join(missing)}, which Python {sys.version.split()[0]} of this process "
            f"does not find in {', '.join(sys.path[1:])}"
        )
        sys.stderr.write(f"touchdown: {text}\n")
        raise ImportError(text)


def why_not_compiled():
    """Why numba compiles nothing here; "" where it does."""
    try:
        import numba

        if numba.config.DISABLE_JIT:  # type: ignore[attr-defined]
            return "numba is told not to compile; unset NUMBA_DISABLE_JIT"
        return "" if numba.njit(lambda x: x + 1.0)(1.0) == 2.0 else "numba compiles wrongly"
    except Exception as error:
        return f"numba does not compile ({(str(error).strip() or repr(error)).splitlines()[-1]})"
