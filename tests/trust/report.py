#!/usr/bin/env python3
"""Puts the records in reports/trust together to reports/trust/README.md. A record that is not there is said to be missing.

    tests/trust/kills.sh 300; tests/trust/slurm.sh target/release/rockfall; tests/trust/fuzz.sh 600
    tests/trust/attack.py target/release/rockfall 1 2 3; ROCKFALL_QEMU=qemu-x86_64 tests/trust/processors.sh target/release/rockfall
    tests/trust/load.py target/release/rockfall CASE...; tests/trust/report.py
"""

import json
import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TRUST = ROOT / "reports/trust"


def record(name):
    file = TRUST / name
    return file.read_text().strip() if file.exists() else "not yet recorded"


def kept_inputs():
    """Wrong scenes and meshes that are kept with their messages."""
    scenes = len(list((ROOT / "tests/bad").glob("*.toml")))
    return scenes, len((ROOT / "tests/bad_meshes/messages.txt").read_text().splitlines())


def figures():
    """The records in short."""
    attack, processors = record("attack.txt"), record("processors.txt")
    total = lambda words, text: sum(int(number) for number in re.findall(r"(\d+) " + words, text))
    numbers = lambda pattern: re.search(pattern, attack).groups() if re.search(pattern, attack) else ("?",) * 4
    tried, refused, most_mb, longest_s = numbers(r"wrong inputs (\d+): (\d+) refused.*\n.*at most (\d+) MB .* and ([\d.]+) s")
    extreme = numbers(r"extreme scenes (\d+):")[0]
    findings = numbers(r"(\d+) findings")[0]
    lines = [
        f"wrong inputs made by chance: {tried}, of which {refused} refused; the dearest refusal took {most_mb} MB and the longest {longest_s} s; "
        f"extreme scenes: {extreme}; findings: {findings}",
        f"wrong inputs kept with their messages: {sum(kept_inputs())}",
        f"SIGKILLs: {total('kills in', record('kills.txt'))} of plain runs, {total('kills in', record('until.txt'))} under `--until` with "
        "maps; all were resumed to the same bytes",
        f"bytes compared without FMA and on an emulated processor: {total('bytes compared', processors):,}; files that differ: "
        f"{total('files differ', processors)}",
    ]
    return "\n".join(f"- {line}" for line in lines)


def bad_inputs():
    scenes, meshes = kept_inputs()
    return (
        f"{scenes} wrong scenes (`tests/bad`) and {meshes} wrong meshes (`tests/bad_meshes`), each with the message that it must "
        f"give: {scenes + meshes} inputs refused with exit status 2 and one line (`cargo test --test commands bad_input::`, in every run of "
        "the check). Folders that cannot be written, full disks and disks that may only be read: `cargo test --test commands full_disk::`; "
        "the full ones are resumed to the same bytes once there is room."
    )


def load_table(load):
    lines = [
        "| case | releases | triangles | peak memory (MB) | resident in tenths of the run (MB) | releases per processor second in tenths |",
        "|---|---|---|---|---|---|",
    ]
    for name, case in load.items():
        row = [name, f"{case['releases']:,}", f"{case['triangles']:,}", f"{case['peak_mb']}"]
        row += [" ".join(map(str, case[key])) for key in ("resident_mb_in_tenths", "releases_per_cpu_s_in_tenths")]
        lines.append("| " + " | ".join(row) + " |")
    lines += ["", "| case | read, weld, index, plan (s) | whole run (s) | draw again (s) | releases.csv | paths.csv | report.html |", "|---|---|---|---|---|---|---|"]
    for name, case in load.items():
        size = lambda file: f"{case['bytes'][file] / 1e6:.1f} MB" if file in case["bytes"] else "–"
        row = [name, case["plan_cpu_s"], case["cpu_s"], case["draw_cpu_s"], *map(size, ("releases.csv", "paths.csv", "report.html"))]
        lines.append("| " + " | ".join(map(str, row)) + " |")
    return "\n".join(lines)


def main():
    load = json.loads(record("load.json")) if (TRUST / "load.json").exists() else {}
    rust = tomllib.loads((ROOT / "Cargo.toml").read_text())["package"]["rust-version"]
    text = f"""# Trust: what was tried

Written by `tests/trust/report.py` from the records beside it; how to make them anew stands at its head.

{figures()}

## Bad input

{bad_inputs()}

Bytes that nobody thought of, fed to the readers of meshes, scenes, grids, GeoTIFF, Shapefile and GeoJSON, PLY and OBJ, LAS and LAZ (`tests/trust/fuzz.sh`, libFuzzer with overflow checks; the program has no `unsafe` of its own):

```
{record("fuzz.txt")}
```

Scenes, worlds, meshes, grids, drawings, tables, options and files in each other's place, made wrong by chance (`tests/trust/attack.py`);
each must end with one line that says what to write, in 2 s and 300 MB, or with a result. Extreme scenes have allowed values only, on
a slope, in a closed box, between plates, on teeth and on a needle, with every scheme, every fifth of them a world; each must end with a
row for every release and a number in every place. Rocks that failed among them sank into springs of which the plan had warned:

```
{record("attack.txt")}
```

## Interruption

SIGKILL at random moments from the first instant to the last figure, several in one run, then `--resume`; the bytes are compared
with those of a run left alone (`tests/trust/kills.sh`):

```
{record("kills.txt")}
```

The same under `--until`, with maps, in all of its rounds; the bytes are those of a run of as many releases
(`cargo test --test commands until:: -- --ignored --nocapture`):

```
{record("until.txt")}
```

## Unlike processors

Rocks alone and worlds of rocks, natively, with the C library's variants for FMA switched off, and emulated on a processor that has neither
AVX nor FMA (`tests/trust/processors.sh`):

```
{record("processors.txt")}
```

## Shards

The Slurm array of docs/cluster.md, as it stands there, on a node begun for the purpose (`tests/trust/slurm.sh`):

```
{record("slurm.txt")}
```

## Load

The Tyrolean slope (`examples/tyrol.toml`) without paths, lines, barriers and maps, then as it is with them, and a slope of
two million triangles with 200 paths, a line and maps (`tests/trust/load.py`). All times are seconds of the processor, not of the
clock on the wall: the machine did other things meanwhile.

{load_table(load) if load else "not yet recorded"}

## Rust

The stated minimum, {rust}, is checked twice: no dependency states a newer one (`cargo test --test commands rust_version::`), and clippy's
`incompatible_msrv` refuses any part of the standard library that came later. There is no `unsafe` (`unsafe_code = "forbid"`).
"""
    (TRUST / "README.md").write_text(re.sub(r"\n{3,}", "\n\n", text))


main()
