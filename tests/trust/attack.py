#!/usr/bin/env python3
"""Wrong inputs made by chance: scenes with one or two keys set to what they must not be, worlds, spoilt meshes, grids,
drawings and tables, files in each other's place, pipes and devices, options. Every one must end soon, with words or with a
result. Extreme scenes, every value of which is allowed, end with a row for each release and a number in every place.

    tests/trust/attack.py target/release/rockfall [SEED...]    writes reports/trust/attack.txt; exit status 1 with findings
"""

import csv
import os
import random
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from made import MESHES, NO_SLOPES, geotiff, plane, spoilt, stl

ROOT = Path(__file__).resolve().parents[2]
LONGEST_S = 60.0  # for any answer
REFUSAL_S, REFUSAL_MB = 2.0, 300.0

SCENE = {
    "title": '"Attack"', "seed": "5", "gravity_m_s2": "9.81",
    "terrain.mesh": '"mesh.stl"', "terrain.ground": '"rock"',
    "grounds.rock.normal_stiffness_n_m": "1e8", "grounds.rock.shear_stiffness_n_m": "2.5e7",
    "grounds.rock.friction_angle_deg": "30.0", "grounds.rock.restitution": "0.4", "grounds.rock.rolling_friction": "0.3",
    "rocks.density_kg_m3": "2700.0", "rocks.radius_m": "0.2",
    "release.count": "4", "release.height_m": "1.0", "release.velocity_m_s": "[0.0, 0.0, 0.0]",
    "release.spin_rad_s": "[0.0, 0.0, 0.0]", "release.points_m": "[[0.0, 0.0]]",
}
WORLD = SCENE | {
    "release.together": "true", "release.points_m": "[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [3.0, 0.0]]",
    "rocks.contact.normal_stiffness_n_m": "1e8", "rocks.contact.shear_stiffness_n_m": "2.5e7",
    "rocks.contact.friction_angle_deg": "30.0", "rocks.contact.restitution": "0.3",
    "rocks.contact.tensile_strength_pa": "0.0", "rocks.contact.cohesion_pa": "0.0",
}
FURTHER = """grounds.rock.tangential_ratio grounds.rock.roughness_deg grounds.rock.roughness_length_m grounds.rock.breaks_above_j
grounds.rock.like terrain.scale terrain.up terrain.resample_m terrain.file origin_m epsg solver.scheme solver.tolerance_m_s
solver.step_s solver.longest_s solver.capture_speed_m_s solver.rest_speed_m_s solver.rest_time_s solver.shear_memory record.paths
record.path_step_s record.impacts maps.cell_m lines.name lines.points_m release.line_m release.polygon_m release.table
release.zones release.together calibrate.deposits calibrate.vary calibrate.held_out mesh.weld_tolerance_m report.author
objects.points_m barriers.points_m barriers.height_m frequency.sources frequency.exponent ground_zones.file unknown.key""".split()
VALUES = """0;-1;1;0.0;-0.0;1e300;-1e300;1e-300;nan;inf;-inf;1e18;1e-18;9223372036854775807;99999999999999999999;"1";"";true;[];[1];
[[1]];{};{ uniform = [0, 1] };{ uniform = [1, 1e300] };{ normal = { mean = 0, sd = 1e300, min = -1e300, max = 1e300 } };
{ values = [] };{ values = [1, nan] };{ lognormal = { median = 1, sigma = 50, min = 0, max = 1e9 } };{ triangular = [3, 2, 1] };
1979-05-27;"../../../../etc/passwd";[0.0, 0.0, 1e300];[[0.0, 0.0], [1e300, 0.0]];[[nan, 0.0]];[0.0, 0.0];0x7fffffffffffffff;
"rigid";"dda";"reference";1000000000;1e-6""".replace("\n", "").split(";")
PLACES = ("release.line_m", "release.polygon_m", "release.table", "release.zones")
RELEASES = 4  # of each scene
LISTS = ("terrain", "trees", "lines", "barriers", "objects", "ground_zones")


def text_of(scene):
    tables = {"": []}
    for trail, value in scene.items():
        table, _, key = trail.rpartition(".")
        tables.setdefault(table, []).append(f"{key} = {value}")
    head = lambda table: f"[[{table}]]" if table in LISTS else f"[{table}]"
    return "\n".join("\n".join(([head(table)] if table else []) + rows) for table, rows in tables.items()) + "\n"


def with_values(scene, changes):
    scene = scene | dict(changes)
    if any(key in PLACES for key, _ in changes):
        scene.pop("release.points_m", None)
    if any(key == "terrain.file" for key, _ in changes):
        scene.pop("terrain.mesh", None)
    return scene


def cases(chance, program):
    """What, the arguments, and the files that belong to them."""
    scene = lambda what, scene: (what, ["run", "scene.toml"], {"scene.toml": text_of(scene).encode()})
    pairs = [(key, value) for key in [*SCENE, *FURTHER] for value in VALUES]
    for change in chance.sample(pairs, 700):
        yield scene(f"{change[0]} = {change[1]}", with_values(SCENE, [change]))
    for _ in range(200):
        changes = chance.sample(pairs, 2)
        yield scene(f"{changes}", with_values(SCENE, changes))
    pairs = [(key, value) for key in WORLD if not key.startswith("terrain") for value in VALUES]
    for change in chance.sample(pairs, 200):
        yield scene(f"world, {change[0]} = {change[1]}", with_values(WORLD, [change]))
    base = {"scene.toml": text_of(with_values(SCENE, [("terrain.mesh", '"m.stl"')])).encode()}
    triangle = struct.pack("<12fH", 0, 0, 1, -20, -20, 0, 20, -20, 0, 20, 20, 0, 0)
    for number in range(100):
        yield f"spoilt text {number}", ["run", "scene.toml"], base | {"m.stl": spoilt(stl(plane(20.0, 0.5)), chance)}
        count = struct.pack("<I", chance.choice([0, 1, 2, 3, 2**31, 2**32 - 1]))
        binary = bytes(80) + count + triangle * chance.choice([1, 2, 3])
        yield f"spoilt binary {number}", ["run", "scene.toml"], base | {"m.stl": spoilt(binary, chance, 80)}
    for columns in ("0", "1", "2", "-1", "1e9", "100000000", "nan", "9223372036854775807"):
        for cell in ("1", "0", "-1", "1e-300", "1e300", "nan"):
            corner = chance.choice(["0", "1e300", "nan"])
            grid = f"ncols {columns}\nnrows 2\nxllcorner {corner}\nyllcorner {corner}\ncellsize {cell}\n1 2\n3 4\n"
            yield f"grid {columns}, {cell}", ["mesh", "from-grid", "g.asc", "o.stl"], {"g.asc": grid.encode()}
    yield from spoilt_inputs(scene, chance)
    yield from swapped(scene, program)
    yield from extremes(chance)
    plain = {"scene.toml": text_of(SCENE).encode()}
    for option in (
        "--releases 0", "--releases -1", "--releases 99999999999999999999", "--threads 0", "--threads 1000000", "--only -1",
        "--only 99999999", "--shard 0/0", "--shard 3/2", "--shard 1/99999999999", "--until runout.p95<nanm", "--until x",
        "--seed -1", "--seed 1e3", "--out /dev/null", "--out /proc/x", "--out mesh.stl", "--resume --overwrite",
    ):
        yield f"run {option}", ["run", "scene.toml", *option.split()], plain
    vary = '[{ ground = "rock", key = "KEY", from = 0.1, to = 0.5, before = 0.3 }]'
    for key in ("restitution", "tangential_ratio", "rolling_friction_spread", "colour"):
        for share in VALUES[:20]:
            changes = [("calibrate.deposits", '"ends.csv"'), ("calibrate.held_out", share), ("calibrate.vary", vary.replace("KEY", key))]
            files = {"scene.toml": text_of(with_values(SCENE, changes)).encode()}
            yield f"calibrate {key} {share}", ["calibrate", "scene.toml", "--releases", "4", "--out", "fit"], files


# files of other kinds, and the key that may name them
SEEDS = (
    ("terrain.file", "fuzz/seeds/geotiff/*"), ("terrain.file", "fuzz/seeds/ply/*"), ("terrain.file", "fuzz/seeds/las/*"),
    ("release.zones", "terrain/*.geojson"), ("ground_zones.file", "terrain/*.geojson"), ("lines.file", "terrain/*.geojson"),
    ("trees.file", "terrain/*.geojson"), ("release.table", "terrain/tschamut/*.csv"), ("calibrate.deposits", "terrain/tschamut/*.csv"),
)


def spoilt_inputs(scene, chance):
    """Files of every other kind with some bytes changed, and elevation models that are no slope."""
    for key, pattern in SEEDS:
        for path, number in [(path, number) for path in sorted(ROOT.glob(pattern)) for number in range(12)]:
            changes = [(key, '"spoilt"')]
            if key.startswith(("ground_zones", "trees")):
                changes.append((key.replace("file", "ground"), '"rock"'))
            what, args, files = scene(f"spoilt {path.name} as {key}, {number}", with_values(SCENE, changes))
            yield what, args, files | {"spoilt": spoilt(path.read_bytes(), chance)}
    for name, made in NO_SLOPES.items():
        yield f"GeoTIFF, {name}", ["mesh", "from-grid", "g.tif", "o.stl"], {"g.tif": geotiff(*made)}


def extremes(chance):
    """Scenes whose every value is allowed, far from the usual ones, on meshes that are no slope; every fifth a world."""
    schemes = (
        lambda: {}, lambda: {"tolerance_m_s": log(-9, 0)}, lambda: {"scheme": '"rigid"'}, lambda: {"scheme": '"reference"'},
        lambda: {"scheme": '"dda"', "step_s": log(-5, -3)},
    )
    log = lambda low, high: f"{10 ** chance.uniform(low, high):.4e}"
    for number in range(400):
        mesh, is_world = chance.choice(list(MESHES)), number % 5 == 4
        radius = chance.uniform(-3, 1.5 if mesh in ("slope", "needle") else -0.5)
        spring = 3 * radius + chance.uniform(9, 14)  # the mass grows with the cube
        ground = {
            "normal_stiffness_n_m": f"{10 ** spring:.4e}", "shear_stiffness_n_m": f"{10 ** (spring - chance.uniform(0, 2)):.4e}",
            "friction_angle_deg": chance.choice(["0.0", "1e-9", "30.0", "60.0", "89.9"]),
            "restitution": chance.choice(["0.0", "1e-6", "0.5", "0.999", "1.0"]),
        }
        changes = {f"grounds.rock.{key}": value for key, value in ground.items()} | {
            "grounds.rock.rolling_friction": chance.choice(["0.0", "0.3", "1.0"]),
            "rocks.density_kg_m3": log(0, 5), "rocks.radius_m": f"{10 ** radius:.4e}", "release.height_m": log(-6, 0.3),
            "release.velocity_m_s": str([round(chance.uniform(-30, 30), 3) for _ in range(3)]),
            "release.spin_rad_s": f"[0.0, {chance.uniform(-100, 100):.3f}, 0.0]",
            "solver.longest_s": log(-2, 2), "terrain.mesh": '"extreme.stl"',
        }
        changes |= {f"solver.{key}": value for key, value in chance.choice(schemes)().items()}
        if is_world:
            d = 3 * 10 ** radius
            changes |= {f"rocks.contact.{key}": value for key, value in ground.items()}
            changes["release.points_m"] = f"[[0.0, 0.0], [{d:.5e}, 0.0], [0.0, {d:.5e}], [{d:.5e}, {d:.5e}]]"
        if chance.random() < 0.3:
            changes["grounds.rock.roughness_deg"] = chance.choice(["5.0", "30.0", "60.0"])
        text = text_of((WORLD if is_world else SCENE) | changes)
        yield f"extreme {number}, {mesh}", ["run", "scene.toml"], {"scene.toml": text.encode(), "extreme.stl": stl(MESHES[mesh])}


def swapped(scene, program):
    files = ["mesh.stl", "ends.csv", "pointer", "pipe", "/dev/zero", "/dev/urandom", ".", "scene.toml", program, "none", "/dev/null",
             "/dev/full", "/proc/self/mem", "/proc/self/maps"]
    plain = {"scene.toml": text_of(SCENE).encode()}
    for file in files:
        for key in ("terrain.mesh", "terrain.file", "release.table", "release.zones", "calibrate.deposits", "ground_zones.file"):
            yield scene(f"{key} is {file}", with_values(SCENE, [(key, f'"{file}"')]))
        for args in (
            ["run", file], ["plan", file], ["mesh", "check", file], ["mesh", "from-grid", file, "o.stl"], ["calibrate", file],
            ["mesh", "stems", file, "mesh.stl", "o.stl"], ["draw", file], ["merge", file, "--out", "merged"], ["compare", file, file],
        ):
            yield " ".join(args[:2]) + f" {file}", args, plain


def answer(program, args):
    """Exit status (None if it had to be ended), seconds, megabytes, stderr."""
    own = ["--quiet", "--overwrite", "--out", "out"] if args[0] == "run" and "--out" not in args and "--resume" not in args else []
    with open("said", "wb") as said, open("printed", "wb") as printed:
        begun = time.monotonic()
        child = subprocess.Popen([program, *args, *own], stdout=printed, stderr=said, stdin=subprocess.DEVNULL)
        late = False
        while True:
            pid, status, used = os.wait4(child.pid, os.WNOHANG)
            took = time.monotonic() - begun
            if pid:
                break
            if took > LONGEST_S and not late:
                late = True
                child.kill()
            time.sleep(0.002)
        child.returncode = 0
    text = Path("said").read_bytes().decode("utf-8", "replace")
    return (None if late else os.waitstatus_to_exitcode(status)), took, used.ru_maxrss / 1024, text


def finding(status, took, memory, said):
    """What is wrong with an answer; none if nothing is."""
    if status is None:
        return "did not end"
    if "panicked" in said or status not in (0, 2):
        return f"exit status {status}"
    if status == 0:
        return None
    of_options = "For more information" in said or "Usage" in said
    if not said.startswith("error: ") or not (of_options or (said.count("\n") == 1 and "; " in said)):
        return "not one line that says what to write"
    if any(ord(letter) < 32 and letter != "\n" for letter in said):
        return "control characters"
    if took > REFUSAL_S or memory > REFUSAL_MB:
        return "a refusal that is not prompt and frugal"
    return None


def wrong_rows(stops):
    """What is wrong with the rows of an extreme scene; counts how its rocks ended."""
    with open("out/releases.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    if len(rows) != RELEASES:
        return f"{len(rows)} rows"
    for row in rows:
        stops[row["stop"]] = stops.get(row["stop"], 0) + 1
        is_number = lambda cell: cell == "" or cell.lstrip("-")[:1].isdigit()
        if row["stop"] not in ("failed", "not_released") and not all(is_number(cell) for key, cell in row.items() if key != "stop"):
            return f"no number in row {row['index']}"
    return None


class Record:
    """What was tried and what was found, of some kind of input."""

    def __init__(self):
        self.tried = {}
        self.refusal_mb = self.refusal_s = self.result_s = (0.0, "")

    def add(self, what, status, took, memory):
        self.tried[status] = self.tried.get(status, 0) + 1
        if status == 2:
            self.refusal_mb, self.refusal_s = max(self.refusal_mb, (memory, what)), max(self.refusal_s, (took, what))
        elif status == 0:
            self.result_s = max(self.result_s, (took, what))

    def __str__(self):
        count = lambda status: self.tried.get(status, 0)
        return (
            f"{sum(self.tried.values())}: {count(2)} refused, {count(0)} with a result\n"
            f"  refusals take at most {self.refusal_mb[0]:.0f} MB ({self.refusal_mb[1]}) and {self.refusal_s[0]:.2f} s ({self.refusal_s[1]})\n"
            f"  results take at most {self.result_s[0]:.1f} s ({self.result_s[1]})\n"
        )


def main():
    program = str(Path(sys.argv[1]).resolve())
    seeds = [int(seed) for seed in sys.argv[2:]] or [1]
    wrong, extreme, stops, findings = Record(), Record(), {}, []
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        Path("mesh.stl").write_bytes(stl(plane(20.0, 0.5)))
        Path("ends.csv").write_text("release_x_m,release_y_m,x_m,y_m\n0,0,1,1\n0,0,2,2\n0,0,3,3\n")
        Path("pointer").write_text("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n")
        os.mkfifo("pipe")
        for seed, (what, args, files) in [(seed, case) for seed in seeds for case in cases(random.Random(seed), program)]:
            for name, data in files.items():
                Path(name).write_bytes(data)
            status, took, memory, said = answer(program, args)
            is_extreme = what.startswith("extreme")
            (extreme if is_extreme else wrong).add(what, status, took, memory)
            found = finding(status, took, memory, said) or (is_extreme and status == 0 and wrong_rows(stops))
            if found:
                findings.append(f"seed {seed}, {what}: {found} ({took:.1f} s, {memory:.0f} MB): {said[:200].strip()}")
        os.chdir(ROOT)
    ends = ", ".join(f"{count} {stop}" for stop, count in sorted(stops.items()))
    text = f"wrong inputs {wrong}extreme scenes {extreme}  ends of their rocks: {ends}\n{len(findings)} findings\n"
    text += "".join(line + "\n" for line in findings)
    print(text, end="")
    (ROOT / "reports/trust/attack.txt").write_text(text)
    sys.exit(1 if findings else 0)


if __name__ == "__main__":
    main()
