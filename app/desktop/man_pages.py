#!/usr/bin/env python3
"""Manual pages from what the command says of itself: man_pages.py DUPIN FOLDER VERSION writes dupin.1 and dupin-COMMAND.1."""
import pathlib
import re
import subprocess
import sys


def text(value):
    value = value.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + value if value[:1] in (".", "'") else value


def help_of(dupin, *command):
    return subprocess.run([dupin, *command, "--help"], check=True, capture_output=True, text=True).stdout


def commands_of(help_text):
    listed = re.search(r"^Subcommands:\n((?: .*\n)+)", help_text, re.M)
    return re.findall(r"^  ([a-z]+) ", listed.group(1), re.M) if listed else []


def page(name, help_text, version, others):
    lines = help_text.splitlines()
    summary = next(line for line in lines if line.strip()).strip().rstrip(".")
    out = [f'.TH {name.upper()} 1 "" "Dupin {version}"', ".SH NAME", f"{text(name)} \\- {text(summary)}"]
    for line in lines[lines.index(next(line for line in lines if line.strip())) + 1:]:
        section = re.match(r"^([A-Z][A-Za-z ]*):\s*(.*)$", line)
        option = re.match(r"^  (\S.*?)(?:\s{2,}(\S.*))?$", line)
        if section:
            title = {"Usage": "SYNOPSIS"}.get(section.group(1), section.group(1).upper())
            out += [f'.SH "{title}"'] + ([text(section.group(2))] if section.group(2) else [])
        elif option:
            out += [".TP", f"\\fB{text(option.group(1))}\\fR"] + ([text(option.group(2))] if option.group(2) else [])
        elif line.strip():
            out.append(text(line.strip()))
    if others:
        out += [".SH \"SEE ALSO\"", ", ".join(f"\\fB{text(o)}\\fR(1)" for o in others)]
    return "\n".join(out) + "\n"


def main():
    dupin, folder, version = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3]
    folder.mkdir(parents=True, exist_ok=True)
    whole = help_of(dupin)
    commands = commands_of(whole)
    pages = [f"dupin-{c}" for c in commands]
    (folder / "dupin.1").write_text(page("dupin", whole, version, pages))
    for command, name in zip(commands, pages):
        (folder / f"{name}.1").write_text(page(name, help_of(dupin, command), version, ["dupin"]))


if __name__ == "__main__":
    main()
