#!/usr/bin/env python3
"""
Run a command in this checkout's own virtual environment, made first if it is not there.

    python3 .ci/in_venv.py tree-sway demo
    python3 .ci/in_venv.py pytest

Needs Python 3.10-3.13 on x86_64 Linux, and the network the first time. The package is installed in
editable form with everything the demo and the tests use, the real rclpy and Fast DDS among it, in
the versions of constraints-ros-jazzy.txt. The environment is made anew when the Python differs and
brought up to date when a file that describes the installation has changed. TREE_SWAY_VENV names
another place for it than .venv.

"""

import fcntl
import hashlib
import os
import platform
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
VENV = Path(os.environ.get("TREE_SWAY_VENV") or ROOT / ".venv").absolute()
CONSTRAINTS = ROOT / ".ci" / "constraints-ros-jazzy.txt"
EXTRAS = "ros,bag,plot,gltf,h5,mujoco,test,lint"
PYTHONS = ((3, 10), (3, 13))
#: What a sourced ROS sets; its libraries and these wheels must not meet in one process.
ROS_NAMES = (
    "AMENT_PREFIX_PATH",
    "CMAKE_PREFIX_PATH",
    "COLCON_PREFIX_PATH",
    "LD_LIBRARY_PATH",
    "PYTHONPATH",
    "ROS_DISTRO",
    "ROS_ETC_DIR",
    "ROS_PYTHON_VERSION",
    "ROS_VERSION",
)


def main(command):
    """Make the environment ready and become the command in it."""
    if not command:
        stop("no command given", "for example: python3 .ci/in_venv.py tree-sway demo")
    check_machine()
    environment = without_ros(dict(os.environ))
    environment.pop("PYTHONHOME", None)
    with open(__file__) as lock:  # one set-up at a time, however many start at once
        fcntl.flock(lock, fcntl.LOCK_EX)
        make_ready(environment)
    programs = str(VENV / "bin")
    environment.update(
        VIRTUAL_ENV=str(VENV),
        AMENT_PREFIX_PATH=str(VENV),
        PATH=os.pathsep.join([programs, environment.get("PATH", os.defpath)]),
    )
    program = shutil.which(command[0], path=environment["PATH"])
    if program is None:
        stop("no such command: " + command[0], "what is installed stands in " + programs)
    os.execve(program, [program, *command[1:]], environment)


def stop(what, cure):
    """Say what is wrong and what to do about it, on one line, and end."""
    print(f"in_venv: {what}; {cure}", file=sys.stderr)
    sys.exit(2)


def check_machine():
    """Refuse a Python or a machine that the ROS wheels are not made for."""
    if not PYTHONS[0] <= sys.version_info[:2] <= PYTHONS[1]:
        fitting = [shutil.which(f"python3.{minor}") for minor in (12, 11, 13, 10)]
        found = next(filter(None, fitting), None)
        stop(
            f"Python {platform.python_version()} does not fit, 3.10 to 3.13 do",
            f"run it with {found or 'one of those, from your system or python.org'}",
        )
    if (sys.platform, platform.machine()) != ("linux", "x86_64"):
        stop(
            f"the ROS wheels are for x86_64 Linux, not {platform.machine()} {sys.platform}",
            "use a ROS installation (README), or `pip install .` for the solver without ROS",
        )


def without_ros(environment):
    """Take a sourced ROS installation out of the environment, and say so."""
    if not environment.get("ROS_DISTRO") and not environment.get("AMENT_PREFIX_PATH"):
        return environment
    if environment.get("AMENT_PREFIX_PATH") != str(VENV):
        distro = environment.get("ROS_DISTRO", "ROS")
        say(f"leaving the sourced {distro} aside, as .venv has its own")
    kept = {name: value for name, value in environment.items() if name not in ROS_NAMES}
    search = environment.get("PATH", "").split(os.pathsep)
    kept["PATH"] = os.pathsep.join(p for p in search if not p.startswith("/opt/ros/"))
    return kept


def wanted():
    """Return what the environment must have been made from, as one line."""
    files = [ROOT / name for name in ("setup.py", "setup.cfg", "pyproject.toml", "package.xml")]
    files += [CONSTRAINTS, Path(__file__).resolve()]
    digest = hashlib.sha256()
    for path in files:
        if path.is_file():
            digest.update(path.name.encode() + b"\0" + path.read_bytes())
    version = ".".join(platform.python_version_tuple()[:2])
    return f"{version} {ROOT} {digest.hexdigest()}"


def make_ready(environment):
    """Create the environment and install into it, unless it is there and up to date."""
    stamp = VENV / "tree_sway_ros.stamp"
    runs = (VENV / "bin" / "python").exists() and (VENV / "bin" / "pip").exists()
    made_from = stamp.read_text() if runs and stamp.is_file() else ""
    if made_from == wanted():
        return
    began = time.monotonic()
    if made_from.split()[:1] != wanted().split()[:1]:
        say(f"setting up {VENV}: about two minutes and 1 GB, once")
        make_venv(environment)
    else:
        say(f"bringing {VENV} up to date")
    pip(environment, "setuptools>=70.1,<81")
    target = f"{ROOT}[{EXTRAS}]"
    pip(environment, "-c", str(CONSTRAINTS), "--no-build-isolation", "-e", target)
    link_resources()
    stamp.write_text(wanted())
    say(f"ready after {time.monotonic() - began:.0f} s")


def link_resources():
    """Put in place what an editable installation omits: the ament index, share/ and lib/."""
    index = VENV / "share" / "ament_index" / "resource_index" / "packages"
    share = VENV / "share" / "tree_sway_ros"
    executables = VENV / "lib" / "tree_sway_ros"
    for folder in (share, executables):  # what has gone from the checkout goes here too
        shutil.rmtree(folder, ignore_errors=True)
    links = {index / "tree_sway_ros": ROOT / "resource" / "tree_sway_ros"}
    # File by file: `ros2 launch` looks for its files where os.walk goes, which passes linked
    # folders by.
    shared = [ROOT / "package.xml", *ROOT.glob("launch/*.py"), *ROOT.glob("config/*")]
    links.update({share / path.relative_to(ROOT): path for path in shared})
    for entry_points in VENV.glob("lib/python*/site-packages/tree_sway_ros-*/entry_points.txt"):
        for line in entry_points.read_text().splitlines():
            if "= tree_sway_ros.nodes." in line:
                name = line.split()[0]
                links[executables / name] = VENV / "bin" / name
    for link, target in links.items():
        link.parent.mkdir(parents=True, exist_ok=True)
        if link.is_symlink():
            link.unlink()
        link.symlink_to(target)


def make_venv(environment):
    """Create an empty virtual environment with pip in it."""
    try:
        import ensurepip  # noqa: F401
        import venv  # noqa: F401
    except ImportError:
        stop(
            "this Python cannot make virtual environments (ensurepip is missing)",
            "on Debian or Ubuntu: sudo apt install python3-venv",
        )
    result = subprocess.run(
        [sys.executable, "-m", "venv", "--clear", str(VENV)],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    if result.returncode:
        reason = (result.stdout.strip() or "no reason given").splitlines()[-1]
        stop(f"cannot create {VENV}: {reason}", "make room or rights there and run this again")


def pip(environment, *arguments):
    """Install with pip, one line of progress; its own words go to a log beside the environment."""
    log = VENV / "setup.log"
    command = [str(VENV / "bin" / "python"), "-m", "pip", "install", "--progress-bar", "off"]
    command += ["--disable-pip-version-check", *arguments]
    process = subprocess.Popen(
        command,
        cwd=str(ROOT),
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    seen = []
    count = 0
    with log.open("w") as record:
        for line in process.stdout:
            record.write(line)
            seen.append(line)
            words = line.split()
            if words[:1] == ["Collecting"]:
                count += 1
                progress(f"  {count:3d} packages, now {words[1][:40]}")
            elif words[:2] == ["Installing", "collected"]:
                progress(f"  installing {len(words) - 3} packages")
    progress("")
    if process.wait():
        stop(*failure("".join(seen), log))


def failure(words, log):
    """Return what went wrong and the cure, from pip's words."""
    signs = "NewConnectionError|Name or service|name resolution|ConnectTimeout|ProxyError"
    if re.search(signs, words):
        cure = "connect, or set a proxy, and run again"
        return "no network: the package index cannot be reached", cure
    if "No space left" in words:
        return "the disk is full", f"make about 1 GB of room at {VENV}"
    errors = [line for line in words.splitlines() if line.startswith("ERROR")]
    return (errors or ["pip failed"])[0], f"pip's own words stand in {log}"


def say(text):
    """Print a line for people; standard output belongs to the command."""
    print("in_venv: " + text, file=sys.stderr, flush=True)


def progress(text):
    """Show a line that the next one replaces, where there is a terminal."""
    if sys.stderr.isatty():
        print("\r\033[K" + text, end="", file=sys.stderr, flush=True)


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except KeyboardInterrupt:
        sys.exit("in_venv: interrupted; run it again to go on")
