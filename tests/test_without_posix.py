"""The project without the names of POSIX that Windows lacks: imported and run, on this system."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable

import pytest

from touchdown.modelkit.kernel.cache_folder import VARIABLE, user_cache

BARE = """
import os, select, signal, socket, sys

for name in ("fcntl", "grp", "pty", "pwd", "resource", "syslog", "termios", "tty"):
    sys.modules[name] = None
LACKING = '''
O_CLOEXEC O_DIRECTORY O_NOCTTY O_NOFOLLOW O_NONBLOCK chown chroot fchdir fchmod fchown fork forkpty getegid
geteuid getgid getgroups getloadavg getpgid getpgrp getpriority getresuid getsid getuid killpg lchown
memfd_create mkfifo mknod nice openpty posix_fallocate posix_spawn posix_spawnp pread preadv pwrite pwritev
register_at_fork sched_getaffinity sched_setaffinity sched_yield sendfile setpgid setpriority setsid setuid
statvfs sync sysconf tcgetpgrp wait3 wait4
'''.split()
for name in LACKING:
    if hasattr(os, name):
        delattr(os, name)
HAS = {"SIGABRT", "SIGFPE", "SIGILL", "SIGINT", "SIGSEGV", "SIGTERM", "SIG_DFL", "SIG_IGN"}
CALLS = {"alarm", "pause", "pthread_kill", "pthread_sigmask", "setitimer", "siginterrupt", "sigwait"}
CALLS.add("sigwaitinfo")
for name in dir(signal):
    if name in CALLS or (name.startswith("SIG") and name not in HAS):
        delattr(signal, name)
for name in ("epoll", "poll"):
    delattr(select, name)
delattr(socket, "AF_UNIX")
"""
EVERY_MODULE = """
import pkgutil, importlib, os, touchdown
assert not hasattr(os, "fork")
names = [module.name for module in pkgutil.walk_packages(touchdown.__path__, "touchdown.")]
for name in names:
    if name not in ("touchdown.__main__", "touchdown.fmus.python.resident"):  # which run at once
        importlib.import_module(name)
print(len(names))
"""
SCENE = "disk-caged-simplified", "--swap", "bearing=bushing", "--duration", "2 ms"
Bare = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="module")
def bare(tmp_path_factory: pytest.TempPathFactory) -> Bare:
    """Run Python, in one folder, without what Windows lacks."""
    folder = tmp_path_factory.mktemp("bare")
    (folder / "sitecustomize.py").write_text(BARE, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(folder), VARIABLE: str(user_cache())}

    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, *arguments],
            cwd=folder,
            env=environment,
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )

    return run


def test_every_module_is_imported(bare: Bare):
    done = bare("-c", EVERY_MODULE)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) > 200


def test_the_command_runs_a_scene_in_process_and_reports(bare: Bare):
    command = "-c", "import sys; from touchdown.command.cli import main; sys.exit(main())"
    for arguments in (
        ["--help"],
        ["run", *SCENE, "--in-process", "-o", "dropped"],
        ["run", *SCENE, "--in-process", "-o", "dropped"],  # over the one before
        ["report", "dropped"],
        ["build", "bushing"],
    ):
        done = bare(*command, *arguments)
        assert done.returncode == 0, f"{arguments}\n{done.stderr}"
    done = bare("-c", "from pathlib import Path; print(*sorted(map(str, Path().rglob('*.*'))))")
    made = done.stdout.split()
    assert {"dropped/result.h5", "dropped/report.html", "build/bushing.fmu"} <= set(made)


def test_isolation_is_said_to_be_missing(bare: Bare):
    """Of a third-party FMU: one line, which says what to do."""
    script = (
        "from pathlib import Path\n"
        "from touchdown.master.components.isolation.isolated import IsolatedFmu\n"
        "IsolatedFmu('bearing', Path('theirs.fmu'), Path())"
    )
    done = bare("-c", script)
    assert "theirs.fmu cannot run in a process of its own on this system; isolate = false in" in done.stderr
