#!/usr/bin/env python3
"""A study of a sample becomes a page that needs no network, and headless Chromium shows it: report_check.py DUPIN SAMPLE

Exit code 77: skipped, with the reason.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from png_file import png_pixels  # noqa: E402

STUDY = """
title = "A <report> & its test"
models = ["{sample}"]
views = ["iso", {{ name = "close", zoom = 6 }}]
sizes = [128]
frames = 2
pictures = true
[[sweep]]
primitive = "quadric"
tolerance = [0.5, 1, 4]
[[sweep]]
primitive = "triangles"
deflection = [1e-1, 1e-2, 1e-3]
"""


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


def check_page(page):
    for found in re.findall(r'(?:src|href)="([^"#][^"]{0,40})', page):
        assert found.startswith("data:"), f"the page needs {found}"
    assert "@import" not in page and "<script" not in page
    assert "A &lt;report&gt; &amp; its test" in page
    for part in ("Where quadric stands", "Error against time and bytes", "Growth with the number of primitives",
                 "Error against the knobs", "Pictures", "All 12 rows"):
        assert part in page, f"no '{part}'"
    assert page.count("<svg") >= 6, "plots are missing"
    assert page.count("<img") == 2 * (1 + 2 * 6), "a scene's reference, and each row's picture and difference"


def shown(page, folder):
    picture, dom = folder / "page.png", folder / "dom.html"
    browser = [shutil.which("chromium") or shutil.which("chromium-browser"), "--headless", "--no-sandbox", "--disable-gpu",
               "--hide-scrollbars", f"--user-data-dir={folder / 'profile'}", "--host-resolver-rules=MAP * ~NOTFOUND"]
    subprocess.run(browser + ["--window-size=1250,2600", f"--screenshot={picture}", page.as_uri()], check=True, timeout=100, capture_output=True)
    dom.write_bytes(subprocess.run(browser + ["--dump-dom", page.as_uri()], check=True, timeout=100, capture_output=True).stdout)
    return picture, dom.read_text(encoding="utf-8")


def check_shown(picture, dom):
    assert dom.count("<svg") >= 6 and "Where quadric stands" in dom
    width, height, rows, channels = png_pixels(picture)
    assert (width, height) == (1250, 2600), (width, height)
    red = blue = dark = 0
    for row in rows[::2]:
        for x in range(0, len(row), 2 * channels):
            r, g, b = row[x:x + 3]
            red += r > 190 and g < 70 and b < 70
            blue += r < 60 and 90 < g < 150 and b > 150
            dark += r < 80 and g < 80 and b < 80
    assert red > 200, f"quadric's lines are not to be seen: {red}"
    assert blue > 200, f"triangles' lines are not to be seen: {blue}"
    assert dark > 2000, f"there is no text: {dark}"


def main():
    dupin, sample = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    if subprocess.run(["/usr/bin/python3", "-c", "import matplotlib"], capture_output=True).returncode != 0:
        skip("Python's matplotlib is not installed")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        study, results = folder / "study.toml", folder / "results"
        study.write_text(STUDY.format(sample=sample))
        subprocess.run([dupin, "study", study, "-o", results], check=True)
        page = results / "report.html"
        check_page(page.read_text(encoding="utf-8"))
        assert list((results / "plots").glob("*.svg")) and list((results / "plots").glob("*.png"))
        if not (shutil.which("chromium") or shutil.which("chromium-browser")):
            skip("the page is as it should be, but there is no Chromium to look at it with")
        check_shown(*shown(page, folder))
    print("the page is as it should be, and Chromium shows it")


main()
