"""Checks that an FMU makes of its interpreter before anything else is imported.

It travels as a module of its own and imports nothing but what is built into every interpreter: in a host
without Python that was given libpython by the FMU's library, compiled modules can only be imported once
`_share_symbols` was called.
"""

import sys

NEEDED = ("numpy", "scipy", "numba")


def prepare(linked=None):
    """Make the packages importable where the host has no Python of its own, and see that they are there.

    `linked` says what `touchdown build --link-python` found (`fmus.python.link.Interpreter`). Raises
    ImportError with one sentence, which pythonfmu hands to the host's logger; it goes to stderr, too,
    because hosts that log nothing would learn of no reason.
    """
    embedded = not sys.orig_argv  # a Python program has a command line
    if linked and embedded and sys.version == linked["version"]:
        _share_symbols(linked["library"])
        _take_up(linked)
    missing = _missing()
    if missing:
        text = (
            f"this FMU needs {', '.join(missing)}, which Python {sys.version.split()[0]} of this process "
            f"does not find in {', '.join(sys.path[1:])}"
        )
        if linked:
            text += f"; it was linked for the packages in {', '.join(linked['packages'])}"
        sys.stderr.write(f"touchdown: {text}\n")
        raise ImportError(text)


def _share_symbols(library):
    """Let compiled modules see the symbols of libpython.

    They do not name it as their library, and a host that loads the FMU privately has loaded libpython
    privately with it. Asked for a module, the importer opens the library again, with the flags set here,
    before it finds that it is no module.
    """
    import _imp

    class Spec:
        name = "no_module"
        origin = library

    before = sys.getdlopenflags()
    sys.setdlopenflags(0x102)  # RTLD_NOW | RTLD_GLOBAL
    try:
        _imp.create_dynamic(Spec)  # type: ignore[arg-type]
    except ImportError:
        pass
    finally:
        sys.setdlopenflags(before)


def _take_up(linked):
    """Search the standard library and the packages of the interpreter that the FMU was linked for.

    Without a command line the interpreter takes a python3 on PATH for itself, whoever's it is.
    """
    own = [*linked["library_folders"], *linked["packages"]]
    strange = (sys.prefix + "/", sys.exec_prefix + "/", sys.base_prefix + "/")
    others = [path for path in sys.path if path not in own]
    sys.path[:] = [
        *[path for path in others if not path.startswith(strange)],
        *own,
    ]
    sys.prefix = sys.exec_prefix = sys.base_prefix = sys.base_exec_prefix = linked["prefix"]


def _missing():
    from importlib.util import find_spec

    return [name for name in NEEDED if find_spec(name) is None]
