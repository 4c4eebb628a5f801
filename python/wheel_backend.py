"""What `pip install .` calls (PEP 517): CMake builds the package, and a wheel is made of it.

SPDX-License-Identifier: Apache-2.0

OBSCURA_WHEEL_BUILD names the build folder; without it, build/wheel. OBSCURA_JOBS limits how many
compilers run at once.
"""

import base64
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import zipfile

SOURCE = pathlib.Path(__file__).resolve().parent.parent


def _version():
    text = (SOURCE / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(obscura VERSION ([0-9.]+)", text).group(1)


def _metadata():
    return (
        "Metadata-Version: 2.1\n"
        "Name: obscura\n"
        f"Version: {_version()}\n"
        "Summary: Path-traces glTF 2.0 assets on the CPU into arrays of NumPy and HDR EXR\n"
        "License: Apache-2.0\n"
        "Requires-Python: >=3.9\n"
        "Requires-Dist: numpy\n"
    )


def _tag():
    """The wheel's module is for this Python alone, on this kind of machine."""
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = re.sub(r"[-.]", "_", sysconfig.get_platform())
    return f"{python}-{python}-{platform}"


def get_requires_for_build_wheel(config_settings=None):
    """pybind11 where the distribution's is not installed."""
    places = ("/usr/include", "/usr/local/include")
    found = any(os.path.exists(f"{place}/pybind11/pybind11.h") for place in places)
    return [] if found else ["pybind11>=2.10"]


def _pybind11_option():
    try:
        import pybind11
    except ImportError:
        return []
    return [f"-Dpybind11_DIR={pybind11.get_cmake_dir()}"]


def _jobs():
    jobs = os.environ.get("OBSCURA_JOBS")
    return ["-j", jobs] if jobs else []


def _build(stage):
    """Installs the package below a folder: the module finds its library in obscura/lib."""
    build = pathlib.Path(os.environ.get("OBSCURA_WHEEL_BUILD") or SOURCE / "build" / "wheel")
    generator = ["-G", "Ninja"] if shutil.which("ninja") else []
    if (build / "CMakeCache.txt").exists():
        generator = []
    configure = [
        "cmake",
        *generator,
        *("-S", str(SOURCE), "-B", str(build)),
        "-DCMAKE_BUILD_TYPE=Release",
        "-DOBSCURA_TESTS=OFF",
        "-DOBSCURA_PYTHON=ON",
        f"-DPython3_EXECUTABLE={sys.executable}",
        "-DOBSCURA_PYTHON_DIR=.",
        "-DCMAKE_INSTALL_LIBDIR=obscura/lib",
        *_pybind11_option(),
    ]
    subprocess.run(configure, check=True)
    targets = ["obscura_python", "obscura_oiio"]
    subprocess.run(["cmake", "--build", str(build), *_jobs(), "--target", *targets], check=True)
    for component in ("library", "python"):
        install = ["cmake", "--install", str(build), "--prefix", str(stage), "--strip"]
        subprocess.run([*install, "--component", component], check=True)


def _files(stage):
    """(name in the wheel, file). A wheel has no links: the library has its loader's name alone."""
    linked = {path.resolve() for path in stage.rglob("*") if path.is_symlink()}
    for path in sorted(stage.rglob("*")):
        if path.is_file() and (path.is_symlink() or path.resolve() not in linked):
            yield path.relative_to(stage).as_posix(), path


def _record_line(name, data):
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(data)}\n"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    information = f"obscura-{_version()}.dist-info"
    name = f"obscura-{_version()}-{_tag()}.whl"
    with tempfile.TemporaryDirectory() as folder:
        stage = pathlib.Path(folder)
        _build(stage)
        entries = [(entry, path.read_bytes()) for entry, path in _files(stage)]
    wheel = (
        f"Wheel-Version: 1.0\nGenerator: obscura\nRoot-Is-Purelib: false\nTag: {_tag()}\n"
    )
    entries += [
        (f"{information}/METADATA", _metadata().encode()),
        (f"{information}/WHEEL", wheel.encode()),
        (f"{information}/LICENSE", (SOURCE / "LICENSE").read_bytes()),
    ]
    record = "".join(_record_line(entry, data) for entry, data in entries)
    entries.append((f"{information}/RECORD", f"{record}{information}/RECORD,,\n".encode()))
    with zipfile.ZipFile(
        os.path.join(wheel_directory, name), "w", zipfile.ZIP_DEFLATED
    ) as archive:
        for entry, data in entries:
            archive.writestr(entry, data)
    return name


def build_sdist(sdist_directory, config_settings=None):
    """What git knows of the sources."""
    root = f"obscura-{_version()}"
    listed = subprocess.run(
        ["git", "-C", str(SOURCE), "ls-files", "-z"], check=True, capture_output=True, text=True
    )
    name = f"{root}.tar.gz"
    with tempfile.NamedTemporaryFile("w", encoding="utf-8") as information:
        information.write(_metadata())
        information.flush()
        with tarfile.open(os.path.join(sdist_directory, name), "w:gz") as archive:
            archive.add(information.name, f"{root}/PKG-INFO")
            for entry in filter(None, listed.stdout.split("\0")):
                archive.add(SOURCE / entry, f"{root}/{entry}")
    return name
