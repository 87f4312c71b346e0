#!/usr/bin/env python3
"""Runs rockfall under load and records memory, rate and file sizes in reports/trust/load.json.

    tests/trust/load.py path/to/rockfall CASE...      (CASE as below; each takes its time)

The rate is taken against the processor's own clock, not the wall's: the machine may do other things meanwhile.
"""

import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
RECORD = ROOT / "reports/trust/load.json"
PARTS = 10
TICKS_PER_S = os.sysconf("SC_CLK_TCK")


def tyrol(folder, bare):
    text = (ROOT / "examples/tyrol.toml").read_text().replace("../terrain", str(ROOT / "terrain"))
    if bare:  # the world, the rocks and their release; no paths, lines, barriers, maps
        text = text[: text.index("[record]")] + "[record]\npaths = 0\n"
    scene = folder / "tyrol.toml"
    scene.write_text(text)
    return scene


def million_cells(folder, rockfall):
    """A slope of 37 degrees over a flat, 1 km x 1 km at 1 m, rough by a few centimetres: 2 000 000 triangles."""
    n = 1001
    rows = []
    for row in range(n):
        y = n - 1 - row  # an ASCII grid runs from north to south
        fall = 0.75 * max(y - 300, 0)
        rows.append(" ".join(f"{fall + 0.05 * math.sin(1.7 * x + 0.3 * y) * math.sin(0.9 * y):.3f}" for x in range(n)))
    grid, mesh = folder / "slope.asc", folder / "slope.stl"
    head = f"ncols {n}\nnrows {n}\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n"
    grid.write_text(head + "\n".join(rows) + "\n")
    said = subprocess.run([rockfall, "mesh", "from-grid", grid, mesh], check=True, capture_output=True, text=True)
    origin = re.search(r"origin_m = .*?\]", said.stdout).group()
    text = tyrol(folder, True).read_text()
    text = text[: text.index("[[terrain]]")] + '[[terrain]]\nmesh = "slope.stl"\n' + text[text.index('ground = "talus"') :]
    text = re.sub(r"origin_m = .*", origin, text, count=1).replace("epsg = 31287\n", "")
    text = re.sub(r"polygon_m = .*", "polygon_m = [[300.0, 850.0], [700.0, 850.0], [700.0, 900.0], [300.0, 900.0]]", text)
    text = text.replace("paths = 0", "paths = 200\npath_step_s = 0.1")
    text += '\n[[lines]]\nname = "foot"\npoints_m = [[0.0, 300.0], [1000.0, 300.0]]\n\n[maps]\ncell_m = 5.0\n'
    scene = folder / "slope.toml"
    scene.write_text(text)
    return scene


CASES = {
    "tyrol_1e4": (lambda folder, rockfall: tyrol(folder, True), 10_000),
    "tyrol_1e5": (lambda folder, rockfall: tyrol(folder, True), 100_000),
    "tyrol_1e6": (lambda folder, rockfall: tyrol(folder, True), 1_000_000),
    "tyrol_1e5_maps_lines_paths": (lambda folder, rockfall: tyrol(folder, False), 100_000),
    "two_million_triangles_1e4": (million_cells, 10_000),
}


def sample(pid, out):
    """(releases on the disk, processor seconds, resident bytes); none when the run begins or ends."""
    try:
        stat = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
        resident = re.search(r"VmRSS:\s+(\d+) kB", Path(f"/proc/{pid}/status").read_text())
        progress = re.search(r'"done": (\d+)', (out / "progress.json").read_text())
    except (FileNotFoundError, ProcessLookupError):
        return None
    if not (progress and resident):
        return None
    return int(progress.group(1)), (int(stat[11]) + int(stat[12])) / TICKS_PER_S, int(resident.group(1)) * 1024


def tenths(samples, releases):
    """What each tenth of the run took: releases per processor second, resident megabytes at its end.

    Releases reach the disk in chunks that may be longer than a tenth: between two chunks time is shared out evenly.
    """
    steps = [new for old, new in zip([(-1, 0, 0)] + samples, samples) if new[0] != old[0]]

    def at(done):
        for old, new in zip(steps, steps[1:]):
            if old[0] <= done <= new[0]:
                share = (done - old[0]) / (new[0] - old[0])
                return old[1] + share * (new[1] - old[1]), new[2]
        return None

    rates, resident = [], []
    for part in range(PARTS):
        begin, end = at(releases * part / PARTS), at(releases * (part + 1) / PARTS)
        if begin and end and end[0] > begin[0]:
            rates.append(round(releases / PARTS / (end[0] - begin[0])))
            resident.append(round(end[1] / 1e6, 1))
    return rates, resident


def watch(rockfall, scene, releases, out):
    """Runs the scene; gives the samples and what the system says of the process at its end."""
    argv = [rockfall, "run", str(scene), "--releases", str(releases), "--quiet", "--resume", "--out", str(out)]
    pid = os.posix_spawn(rockfall, argv, os.environ)
    samples = []
    while True:
        ended, status, usage = os.wait4(pid, os.WNOHANG)
        if ended:
            assert os.waitstatus_to_exitcode(status) == 0, status
            return samples, usage
        taken = sample(pid, out)
        if taken and (not samples or taken != samples[-1]):
            samples.append(taken)
        time.sleep(0.2)


def seconds(command):
    begun = os.times()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    ended = os.times()
    return ended.children_user + ended.children_system - begun.children_user - begun.children_system


def case(rockfall, name, folder):
    make, releases = CASES[name]
    scene = make(folder, rockfall)
    meshes = re.findall(r'mesh = "(.*)"', scene.read_text())
    triangles = sum(((folder / mesh).stat().st_size - 84) // 50 for mesh in meshes)
    plan_cpu_s = seconds([rockfall, "plan", scene])
    out = folder / "out"
    samples, usage = watch(rockfall, scene, releases, out)
    rates, resident = tenths(samples, releases)
    sizes = {file.name: file.stat().st_size for file in sorted(out.glob("*")) if file.is_file() and file.name != ".lock"}
    rows = sum(1 for _ in open(out / "releases.csv")) - 1
    assert rows == releases, rows
    # reading the results again, drawing figures and page
    draw_cpu_s = seconds([rockfall, "draw", out])
    return {
        "releases": releases,
        "triangles": triangles,
        "peak_mb": round(usage.ru_maxrss * 1024 / 1e6, 1),
        "resident_mb_in_tenths": resident,
        "releases_per_cpu_s_in_tenths": rates,
        "cpu_s": round(usage.ru_utime + usage.ru_stime, 1),
        "plan_cpu_s": round(plan_cpu_s, 2),
        "draw_cpu_s": round(draw_cpu_s, 2),
        "bytes": sizes,
        "figures_bytes": sum(file.stat().st_size for file in (out / "figures").iterdir()),
    }


def main():
    rockfall, names = str(Path(sys.argv[1]).resolve()), sys.argv[2:]
    for name in names:
        with tempfile.TemporaryDirectory(prefix="rockfall_load_", dir=os.environ.get("ROCKFALL_LOAD_DIR")) as folder:
            found = case(rockfall, name, Path(folder))
            if os.environ.get("ROCKFALL_LOAD_KEEP"):
                shutil.copytree(Path(folder) / "out", Path(os.environ["ROCKFALL_LOAD_KEEP"]) / name)
        RECORD.parent.mkdir(parents=True, exist_ok=True)
        record = json.loads(RECORD.read_text()) if RECORD.exists() else {}
        record[name] = found
        RECORD.write_text(json.dumps({key: record[key] for key in CASES if key in record}, indent=1) + "\n")
        print(name, json.dumps(found), flush=True)


main()
