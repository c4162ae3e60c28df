#!/usr/bin/env python3
"""The Debian package, unpacked into an empty folder and tried there: package_test.py BUILD SAMPLES WORK."""
import configparser
import glob
import os
import shutil
import subprocess
import sys
import unittest

BUILD, SAMPLES, WORK = sys.argv[1:4]
ROOT = os.path.join(WORK, "root")
ENVIRONMENT = {"PATH": os.path.join(ROOT, "usr/bin") + ":/usr/bin:/bin", "HOME": WORK, "LC_ALL": "C.UTF-8"}


def run(*command, **options):
    return subprocess.run(command, check=True, capture_output=True, text=True, env=ENVIRONMENT, **options).stdout


def setUpModule():
    shutil.rmtree(WORK, ignore_errors=True)
    os.makedirs(WORK)
    run("cpack", "-G", "DEB", "-B", os.path.join(WORK, "package"), cwd=BUILD)
    run("dpkg-deb", "-x", package(), ROOT)


def package():
    packages = glob.glob(os.path.join(WORK, "package", "*.deb"))
    assert len(packages) == 1, packages
    return packages[0]


class Package(unittest.TestCase):
    def test_says_what_it_needs(self):
        fields = run("dpkg-deb", "-f", package())
        self.assertIn("Package: dupin\n", fields)
        for needed in ("libtbb", "libocct", "libopenexr", "libc6"):
            self.assertIn(needed, fields)

    def test_draws_where_it_was_unpacked(self):
        picture = os.path.join(WORK, "bracket.png")
        run("dupin", "render", os.path.join(SAMPLES, "bracket.step"), "-o", picture, "--resolution", "64,64", "--quiet")
        with open(picture, "rb") as file:
            self.assertEqual(file.read(8), b"\x89PNG\r\n\x1a\n")

    def test_has_the_c_interface(self):
        for name in ("include/dupin.h", "lib/**/libdupin.so.1", "lib/**/pkgconfig/dupin-c.pc"):
            self.assertTrue(glob.glob(os.path.join(ROOT, "usr", name), recursive=True), name)


class Desktop(unittest.TestCase):
    def test_makes_a_thumbnail_as_a_file_manager_does(self):
        entry = configparser.ConfigParser(interpolation=None)
        entry.read(os.path.join(ROOT, "usr/share/thumbnailers/dupin.thumbnailer"))
        picture = os.path.join(WORK, "thumbnail.png")
        values = {"%i": os.path.join(SAMPLES, "assembly.step"), "%o": picture}
        command = [values.get(word, word.replace("%s", "128")) for word in entry["Thumbnailer Entry"]["Exec"].split()]
        run(*command)
        with open(picture, "rb") as file:
            header = file.read(24)
        self.assertEqual(int.from_bytes(header[16:20], "big"), 128)
        self.assertIn("model/step", entry["Thumbnailer Entry"]["MimeType"])

    def test_knows_the_file_types(self):
        if not shutil.which("update-mime-database"):
            self.skipTest("no shared-mime-info")
        run("update-mime-database", os.path.join(ROOT, "usr/share/mime"))
        with open(os.path.join(ROOT, "usr/share/mime/globs2")) as file:
            globs = file.read()
        for pattern in ("model/step:*.step", "model/iges:*.igs", "application/x-brep:*.brep", "application/x-extension-fcstd:*.fcstd"):
            self.assertIn(pattern, globs)

    def test_manual_pages_are_the_help(self):
        pages = os.path.join(ROOT, "usr/share/man/man1")
        commands = [line.split()[0] for line in run("dupin", "--help").split("Subcommands:")[1].split("\n\n")[0].strip().splitlines()]
        self.assertIn("render", commands)
        for command in commands:
            with open(os.path.join(pages, f"dupin-{command}.1")) as file:
                text = file.read().replace("\\-", "-")
            for word in run("dupin", command, "--help").split():
                if word.startswith("--") and word.strip("-").replace("-", "").isalpha():
                    self.assertIn(word, text, command)
        if shutil.which("man"):
            self.assertIn("DUPIN-RENDER(1)", run("man", "-l", os.path.join(pages, "dupin-render.1")))

    def complete(self, *words):
        script = os.path.join(ROOT, "usr/share/bash-completion/completions/dupin")
        line = f'source {script}; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _dupin; printf "%s\\n" "${{COMPREPLY[@]}}"'
        return run("bash", "-c", line, "bash", *words).split()

    def test_the_shell_completes(self):
        self.assertIn("render", self.complete("dupin", "re"))
        self.assertEqual(self.complete("dupin", "render", "--sect"), ["--section"])
        self.assertEqual(self.complete("dupin", "render", "--shading", "ze"), ["zebra"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
