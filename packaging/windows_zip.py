#!/usr/bin/env python3
"""Packs the program for Windows and its documents into a zip (docs/guide/install.md).

    python3 packaging/windows_zip.py [EXE [FOLDER]]

Writes partsight-VERSION-x86_64-windows.zip into the folder, or into target/windows, and prints its path. Without EXE, it
builds the program first, which on Linux needs MinGW-w64 and `rustup target add x86_64-pc-windows-gnu`. Needs Python 3.11
or newer.
"""

import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TARGET = "x86_64-pc-windows-gnu"
DOCUMENTS = "usr/share/doc/partsight/"


def build() -> Path:
    subprocess.run(["cargo", "build", "--release", "--locked", "-p", "partsight", "--target", TARGET], cwd=ROOT, check=True)
    return ROOT / "target" / TARGET / "release" / "partsight.exe"


def main() -> None:
    arguments = sys.argv[1:]
    if len(arguments) > 2 or any(argument.startswith("-") for argument in arguments):
        sys.exit(__doc__)
    exe = Path(arguments[0]) if arguments else build()
    if not exe.is_file():
        sys.exit(f"error: {exe}: no such file\n  to do: Name the built program, or no file to build it")
    folder = Path(arguments[1]) if arguments[1:] else ROOT / "target" / "windows"
    package = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))["package"]
    name = f"partsight-{package['version']}-x86_64-windows"
    # The documents of the Debian package.
    files = {"partsight.exe": exe}
    for source, target, _ in package["metadata"]["deb"]["assets"]:
        if target.startswith(DOCUMENTS):
            for path in sorted(ROOT.glob(source)):
                files[target.removeprefix(DOCUMENTS) + path.name] = path
    archive = folder / f"{name}.zip"
    folder.mkdir(parents=True, exist_ok=True)
    unfinished = archive.with_suffix(".part")
    with zipfile.ZipFile(unfinished, "w", zipfile.ZIP_DEFLATED) as pack:
        for inside, path in files.items():
            pack.write(path, f"{name}/{inside}")
    unfinished.replace(archive)
    print(archive)


main()
