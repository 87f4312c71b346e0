//! `view.glb`: the scene as binary glTF 2.0, for Blender, GIS and whatever shows animated scenes.
//!
//! Terrain and trees are meshes, paths are line strips, and every rock is a node that moves: its translation is sampled
//! at the instants of its path, that of a block also its rotation. z points up inside, as everywhere here; the root turns it
//! to y, as glTF has it.
//! Format: The Khronos Group, glTF 2.0 Specification, sections 3 and 4.4.

mod parts;

use super::Shown;
use super::hulls::BlockHull;
use super::mesh::ViewMesh;
use super::paths::{PathInstant, ViewPath};
use parts::{Bin, ball, colour_of};
use serde_json::{Value, json};
use std::f64::consts::{FRAC_1_SQRT_2, PI};

const TRIANGLES: u32 = 4;
const LINE_STRIP: u32 = 3;
/// Materials in the order of [`materials`].
const GROUND: usize = 0;
const TREE: usize = 1;
const ROCK: usize = 2;
const WALL: usize = 3;
const LINE: usize = 4;
const PATH: usize = 5;

/// Most that a block turns between two keyframes (rad): well below the half round where the short way would be the wrong one,
/// and so little that a program which mixes quaternions number by number is 1° off at most.
const MOST_TURN_RAD: f64 = 0.5 * PI;
/// Most attitudes between two instants of a path: a block that spins still faster is a blur whatever is drawn.
const MOST_PIECES: f64 = 256.0;

/// The scene being put together.
struct GltfScene<'a> {
    shown: &'a Shown,
    /// Map position of the scene's (0, 0, 0) (m): 32-bit numbers hold no map coordinates.
    origin_m: [f64; 3],
    bin: Bin,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
    channels: Vec<Value>,
    samplers: Vec<Value>,
}

/// The file.
pub fn glb(shown: &Shown) -> Vec<u8> {
    let first = shown.ways.ways.first().and_then(|way| way.instants.first());
    let origin_m = match (shown.mesh.vertices.is_empty(), first) {
        (true, Some(first)) => first.place_m,
        _ => shown.mesh.frame.low_m,
    };
    let mut scene = GltfScene {
        shown,
        origin_m,
        bin: Bin::default(),
        meshes: Vec::new(),
        nodes: Vec::new(),
        channels: Vec::new(),
        samplers: Vec::new(),
    };
    scene.terrain();
    scene.walls();
    scene.paths();
    scene.rocks();
    scene.written()
}

impl GltfScene<'_> {
    fn local(&self, place_m: [f64; 3]) -> [f32; 3] {
        std::array::from_fn(|axis| (place_m[axis] - self.origin_m[axis]) as f32)
    }

    fn add_mesh(&mut self, primitives: &[Value]) -> usize {
        self.meshes.push(json!({ "primitives": primitives }));
        self.meshes.len() - 1
    }

    fn add_node(&mut self, name: &str, mesh: usize) {
        self.nodes.push(json!({ "name": name, "mesh": mesh }));
    }

    fn terrain(&mut self) {
        let mesh: &ViewMesh = &self.shown.mesh;
        let places: Vec<[f32; 3]> =
            (0..mesh.vertices.len() as u32).map(|v| self.local(mesh.place_m(v))).collect();
        if mesh.triangles.is_empty() {
            return;
        }
        let position = self.bin.places(&places);
        let (ground, trees) = mesh.triangles.split_at(mesh.ground);
        for (name, triangles, material) in [("terrain", ground, GROUND), ("trees", trees, TREE)] {
            if triangles.is_empty() {
                continue;
            }
            let corners = self.bin.corners(triangles.as_flattened());
            let number = self.add_mesh(&[json!({
                "attributes": { "POSITION": position }, "indices": corners,
                "material": material, "mode": TRIANGLES
            })]);
            self.add_node(name, number);
        }
    }

    /// Lines on the ground, barriers as upright sheets.
    fn walls(&mut self) {
        for wall in &self.shown.walls {
            if wall.foot_m.len() < 2 {
                continue;
            }
            let foot = wall.foot_m.iter().map(|place| self.local(*place));
            let (places, mode, material): (Vec<[f32; 3]>, u32, usize) = match wall.height_m {
                None => (foot.collect(), LINE_STRIP, LINE),
                Some(height_m) => {
                    let up = |[x, y, z]: [f32; 3]| [x, y, z + height_m as f32];
                    (foot.flat_map(|low| [low, up(low)]).collect(), TRIANGLES, WALL)
                }
            };
            let attributes = json!({ "POSITION": self.bin.places(&places) });
            let mut primitive =
                json!({ "attributes": attributes, "material": material, "mode": mode });
            if mode == TRIANGLES {
                let pieces = (0..places.len() as u32 / 2 - 1).map(|k| 2 * k);
                let corners: Vec<u32> =
                    pieces.flat_map(|k| [k, k + 2, k + 1, k + 1, k + 2, k + 3]).collect();
                primitive["indices"] = self.bin.corners(&corners).into();
            }
            let number = self.add_mesh(&[primitive]);
            self.add_node(&wall.name, number);
        }
    }

    fn paths(&mut self) {
        let limits_j = super::page::class_limits_j(self.shown);
        let mut primitives = Vec::new();
        for way in self.shown.ways.ways.iter().filter(|way| way.instants.len() > 1) {
            let places: Vec<_> =
                way.instants.iter().map(|instant| self.local(instant.place_m)).collect();
            let colours: Vec<_> =
                way.instants.iter().map(|instant| colour_of(instant.total_j, limits_j)).collect();
            primitives.push(json!({
                "attributes": {
                    "POSITION": self.bin.places(&places), "COLOR_0": self.bin.colours(&colours)
                },
                "material": PATH, "mode": LINE_STRIP
            }));
        }
        if !primitives.is_empty() {
            let number = self.add_mesh(&primitives);
            self.add_node("paths", number);
        }
    }

    /// One ball for all spheres, one hull for all blocks of a shape, one moving node each.
    fn rocks(&mut self) {
        let shown = self.shown;
        let has_balls = shown.ways.ways.iter().any(|way| way.hull.is_none());
        let ball = has_balls.then(|| self.ball());
        let hulls: Vec<usize> = shown.hulls.hulls.iter().map(|hull| self.hull(hull)).collect();
        for way in &shown.ways.ways {
            let Some(mesh) = way.hull.map(|hull| hulls[hull]).or(ball) else { continue };
            let (times, places): (Vec<f32>, Vec<_>) = rising(&way.instants)
                .map(|(time, instant)| (time, self.local(instant.place_m)))
                .unzip();
            let (input, output) = (self.bin.times(&times), self.bin.samples(&places));
            self.channel("translation", (input, output));
            let mut node = json!({
                "name": format!("rock {}", way.release),
                "mesh": mesh,
                "translation": places[0],
                "scale": [way.radius_m, way.radius_m, way.radius_m],
                "extras": { "release": way.release, "radius_m": way.radius_m }
            });
            if way.hull.is_some() {
                let (times, turns) = keyframes(way);
                node["rotation"] = turns[0].into();
                let (input, output) = (self.bin.times(&times), self.bin.turns(&turns));
                self.channel("rotation", (input, output));
            }
            self.nodes.push(node);
        }
    }

    /// Moves the node that comes next.
    fn channel(&mut self, path: &str, (input, output): (usize, usize)) {
        self.channels.push(json!({
            "sampler": self.samplers.len(),
            "target": { "node": self.nodes.len(), "path": path }
        }));
        self.samplers.push(json!({ "input": input, "output": output, "interpolation": "LINEAR" }));
    }

    fn ball(&mut self) -> usize {
        let (places, corners) = ball();
        let attributes = json!({
            "POSITION": self.bin.places(&places), "NORMAL": self.bin.places(&places)
        });
        let corners = self.bin.corners(&corners);
        self.add_mesh(&[json!({
            "attributes": attributes, "indices": corners, "material": ROCK, "mode": TRIANGLES
        })])
    }

    /// Without normals faces are flat (glTF 2.0, 3.7.2.1), as those of a block are.
    fn hull(&mut self, hull: &BlockHull) -> usize {
        let surface = hull.surface();
        let places: Vec<_> =
            surface.points.iter().map(|p| [p.x, p.y, p.z].map(|x| x as f32)).collect();
        let attributes = json!({ "POSITION": self.bin.places(&places) });
        let corners = self.bin.corners(surface.triangles.as_flattened());
        self.add_mesh(&[json!({
            "attributes": attributes, "indices": corners, "material": ROCK, "mode": TRIANGLES
        })])
    }

    fn written(self) -> Vec<u8> {
        let Self { shown, origin_m, bin, meshes, mut nodes, channels, samplers } = self;
        let children: Vec<usize> = (0..nodes.len()).collect();
        let root = nodes.len();
        nodes.push(json!({
            "name": shown.title,
            "rotation": [-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2],
            "extras": { "map_origin_m": origin_m, "notes": shown.notes() }
        }));
        if !children.is_empty() {
            nodes[root]["children"] = children.into();
        }
        let mut head = json!({
            "asset": { "version": "2.0", "generator": concat!("rockfall ", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "nodes": [root] }],
            "nodes": nodes,
        });
        // a list that is there must not be empty
        let mut put = |name: &str, list: Vec<Value>| {
            if !list.is_empty() {
                head[name] = list.into();
            }
        };
        if !channels.is_empty() {
            let all = json!({ "name": "fall", "channels": channels, "samplers": samplers });
            put("animations", vec![all]);
        }
        if !meshes.is_empty() {
            put("materials", materials());
        }
        put("meshes", meshes);
        let numbers = bin.close(&mut put);
        parts::file(&head, numbers)
    }
}

/// Instants with their times in 32 bits, which must rise: the last of those that become one.
fn rising(instants: &[PathInstant]) -> impl Iterator<Item = (f32, &PathInstant)> {
    let time = |instant: &PathInstant| instant.time_s as f32;
    let later = instants.iter().skip(1).map(Some).chain([None]);
    instants
        .iter()
        .zip(later)
        .filter(move |(one, next)| next.is_none_or(|next| time(next) > time(one)))
        .map(move |(one, _)| (time(one), one))
}

/// Times and attitudes (x, y, z, w) between which a block turns by [`MOST_TURN_RAD`] at most; neighbours are on the same side,
/// so that whoever mixes their numbers goes the short way too.
fn keyframes(way: &ViewPath) -> (Vec<f32>, Vec<[f32; 4]>) {
    let (mut times, mut turns): (Vec<f32>, Vec<[f32; 4]>) = (Vec::new(), Vec::new());
    let mut add = |time_s: f64, [w, x, y, z]: [f64; 4]| {
        let turn = [x, y, z, w].map(|x| x as f32);
        let ahead = |last: &[f32; 4]| last.iter().zip(turn).map(|(a, b)| a * b).sum::<f32>() < 0.0;
        let turn = if turns.last().is_some_and(ahead) { turn.map(|x| -x) } else { turn };
        // times of 32 bits must rise too
        if times.last().is_none_or(|last| time_s as f32 > *last) {
            times.push(time_s as f32);
            turns.push(turn);
        }
    };
    let first = &way.instants[0];
    add(first.time_s, first.attitude);
    for (two, turn) in way.instants.windows(2).zip(way.turns()) {
        let pieces = (turn.angle_rad().abs() / MOST_TURN_RAD).ceil().clamp(1.0, MOST_PIECES) as u32;
        for piece in 1..pieces {
            let share = f64::from(piece) / f64::from(pieces);
            let time_s = two[0].time_s + share * (two[1].time_s - two[0].time_s);
            add(time_s, turn.at(two[0].attitude, share));
        }
        add(two[1].time_s, two[1].attitude);
    }
    (times, turns)
}

fn materials() -> Vec<Value> {
    let material = |name: &str, colour: [f64; 4]| {
        let mode = if colour[3] < 1.0 { "BLEND" } else { "OPAQUE" };
        json!({
            "name": name, "doubleSided": true, "alphaMode": mode,
            "pbrMetallicRoughness": {
                "baseColorFactor": colour, "metallicFactor": 0.0, "roughnessFactor": 1.0
            }
        })
    };
    vec![
        material("ground", [0.62, 0.59, 0.51, 1.0]),
        material("tree", [0.15, 0.25, 0.08, 1.0]),
        material("rock", [0.06, 0.06, 0.06, 1.0]),
        material("barrier", [0.0, 0.34, 0.17, 0.5]),
        material("line", [0.2, 0.03, 0.3, 1.0]),
        material("path", [1.0, 1.0, 1.0, 1.0]),
    ]
}
