"""terrain_rebuilt.asc from terrain.asc: beside and past the tracks without the tilted plane of the source (README.md).

Python 3 with numpy, in this folder.
"""
import csv
import numpy as np

CELL_M, BIN_M = 5.0, 5.0

lines = open("terrain.asc").read().splitlines()
heights = np.array([[float(word) for word in line.split()] for line in lines[6:] if line.strip()])
rows, columns = heights.shape
# nodes, not cells: see README.md
x, y = np.meshgrid(-35.0 + CELL_M * np.arange(columns), 85.0 + CELL_M * np.arange(rows)[::-1])

table = list(csv.DictReader(open("observed_deposition.csv")))
starts = np.array([[float(row["release_x_m"]), float(row["release_y_m"])] for row in table])
ends = np.array([[float(row["x_m"]), float(row["y_m"])] for row in table])


def turn(a, b, x_m, y_m):
    """Positive where a place lies to the left of the way from a to b."""
    return (b[0] - a[0]) * (y_m - a[1]) - (b[1] - a[1]) * (x_m - a[0])


def hull(points):
    """Corners of the convex hull, anticlockwise (Andrew's monotone chain)."""
    def half(sequence):
        chain = []
        for p in sequence:
            while len(chain) > 1 and turn(chain[-2], chain[-1], *p) <= 0.0:
                chain.pop()
            chain.append(p)
        return chain[:-1]
    ordered = sorted(points, key=tuple)
    return np.array(half(ordered) + half(ordered[::-1]))


corners = hull(np.vstack([starts, ends]))
# what blocks have passed over, and the cells that they were released in
known = np.all([turn(a, b, x, y) >= 0.0 for a, b in zip(corners, np.roll(corners, -1, axis=0))], axis=0)
for start in starts:
    known |= (abs(x - start[0]) < CELL_M) & (abs(y - start[1]) < CELL_M)
down = (ends - starts).mean(axis=0)
down /= np.linalg.norm(down)
way = (np.stack([x, y], axis=-1) - starts.mean(axis=0)) @ down

# mean profile along the mean way: level past its end, as steep as its first 20 m before its start
places = np.floor(way[known] / BIN_M)
at = np.unique(places)
profile = np.array([heights[known][places == place].mean() for place in at])
middle = (at + 0.5) * BIN_M
steepness = (profile[0] - profile[4]) / (middle[4] - middle[0])
trend = np.interp(way, middle, profile) + steepness * np.maximum(middle[0] - way, 0.0)

# elsewhere: the profile, and how far the nearest known node lies off it
off = (heights - trend)[known]
kx, ky = x[known], y[known]
rebuilt = heights.copy()
for i, j in zip(*np.where(~known)):
    nearest = np.argmin((kx - x[i, j]) ** 2 + (ky - y[i, j]) ** 2)
    rebuilt[i, j] = trend[i, j] + off[nearest]

with open("terrain_rebuilt.asc", "w") as file:
    header = f"ncols {columns}\nnrows {rows}\nxllcenter -35.0\nyllcenter 85.0\ncellsize {CELL_M}\nNODATA_value -9999\n"
    file.write(header + "".join(" ".join(f"{z:.3f}" for z in row) + "\n" for row in rebuilt))
print(f"{known.sum()} of {known.size} heights kept")
