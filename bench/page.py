"""Documents whose numbers are written by scripts: text between `<!-- begin NAME -->` and `<!-- end NAME -->`."""
import os
import pathlib
import platform

ROOT = pathlib.Path(__file__).resolve().parent.parent


def fill(page, name, text):
    """Replaces what stands between the marks of `name`; fails when they are not there."""
    begin, end = f"<!-- begin {name} -->\n", f"<!-- end {name} -->"
    content = page.read_text()
    head, rest = content.split(begin)
    page.write_text(head + begin + text.rstrip() + "\n" + end + rest.split(end)[1])


def table(head, rows):
    """A Markdown table; numbers to the right."""
    right = [all(isinstance(row[i], (int, float)) or row[i][:1].isdigit() for row in rows) for i in range(len(head))]
    lines = ["| " + " | ".join(head) + " |", "|" + "|".join("---:" if r else "---" for r in right) + "|"]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows]) + "\n"


def machine():
    model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), platform.machine())
    return f"{model}, {os.cpu_count()} cores"
