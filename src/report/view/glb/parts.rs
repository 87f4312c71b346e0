//! Pieces of a binary glTF file: numbers, the ball, the file itself.

use serde_json::{Value, json};

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const UNSIGNED_BYTE: u32 = 5121;
/// What numbers are for: vertices, corners of triangles.
const ARRAY: u32 = 34_962;
const ELEMENT_ARRAY: u32 = 34_963;
/// Colours of the classes of energy as linear light, from Okabe and Ito's blue, orange and vermillion.
const CLASSES: [[u8; 4]; 3] = [[0, 43, 115, 255], [201, 89, 0, 255], [170, 28, 0, 255]];

/// Numbers of the file: one view a kind, as accessors of one view share stride and use.
#[derive(Debug, Default)]
pub(super) struct Bin {
    views: [Vec<u8>; 6],
    accessors: Vec<Value>,
}

/// Views: vertices, corners, colours, times, places and turns of samplers.
const PLACES: usize = 0;
const CORNERS: usize = 1;
const COLOURS: usize = 2;
const TIMES: usize = 3;
const SAMPLES: usize = 4;
const TURNS: usize = 5;
/// Use and stride (bytes) of each view.
const USES: [(Option<u32>, Option<u32>); 6] = [
    (Some(ARRAY), Some(12)),
    (Some(ELEMENT_ARRAY), None),
    (Some(ARRAY), Some(4)),
    (None, None),
    (None, None),
    (None, None),
];

impl Bin {
    /// Appends to a view and gives the number of the accessor.
    fn add(&mut self, view: usize, bytes: impl Iterator<Item = u8>, mut accessor: Value) -> usize {
        accessor["bufferView"] = view.into();
        accessor["byteOffset"] = self.views[view].len().into();
        self.views[view].extend(bytes);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn vectors<const N: usize>(&mut self, view: usize, all: &[[f32; N]]) -> usize {
        let fold = |of: fn(f32, f32) -> f32, from: f32| {
            let least = |m: [f32; N], p: &[f32; N]| std::array::from_fn(|i| of(m[i], p[i]));
            all.iter().fold([from; N], least).to_vec()
        };
        let (min, max) = (fold(f32::min, f32::INFINITY), fold(f32::max, f32::NEG_INFINITY));
        let accessor = json!({
            "componentType": FLOAT, "count": all.len(), "type": format!("VEC{N}"),
            "min": min, "max": max
        });
        self.add(view, all.iter().flatten().flat_map(|x| x.to_le_bytes()), accessor)
    }

    pub(super) fn places(&mut self, places: &[[f32; 3]]) -> usize {
        self.vectors(PLACES, places)
    }

    pub(super) fn samples(&mut self, places: &[[f32; 3]]) -> usize {
        self.vectors(SAMPLES, places)
    }

    /// Unit quaternions x, y, z, w.
    pub(super) fn turns(&mut self, turns: &[[f32; 4]]) -> usize {
        self.vectors(TURNS, turns)
    }

    pub(super) fn corners(&mut self, corners: &[u32]) -> usize {
        let accessor =
            json!({ "componentType": UNSIGNED_INT, "count": corners.len(), "type": "SCALAR" });
        self.add(CORNERS, corners.iter().flat_map(|v| v.to_le_bytes()), accessor)
    }

    pub(super) fn colours(&mut self, colours: &[[u8; 4]]) -> usize {
        let accessor = json!({
            "componentType": UNSIGNED_BYTE, "normalized": true, "count": colours.len(), "type": "VEC4"
        });
        self.add(COLOURS, colours.iter().flatten().copied(), accessor)
    }

    /// Rising times (s).
    pub(super) fn times(&mut self, times: &[f32]) -> usize {
        let accessor = json!({
            "componentType": FLOAT, "count": times.len(), "type": "SCALAR",
            "min": [times.first()], "max": [times.last()]
        });
        self.add(TIMES, times.iter().flat_map(|t| t.to_le_bytes()), accessor)
    }

    /// Lists buffer, views and accessors, and gives the bytes of the views, one after the other.
    pub(super) fn close(mut self, put: &mut impl FnMut(&str, Vec<Value>)) -> [Vec<u8>; 6] {
        let (mut length, mut views, mut number) = (0, Vec::new(), [0; 6]);
        for (kind, (own, (target, stride))) in self.views.iter().zip(USES).enumerate() {
            if own.is_empty() {
                continue;
            }
            number[kind] = views.len();
            let mut view = json!({ "buffer": 0, "byteOffset": length, "byteLength": own.len() });
            if let Some(target) = target {
                view["target"] = target.into();
            }
            if let Some(stride) = stride {
                view["byteStride"] = stride.into();
            }
            views.push(view);
            length += own.len();
        }
        for accessor in &mut self.accessors {
            let kind = accessor["bufferView"].as_u64().unwrap_or(0) as usize;
            accessor["bufferView"] = number[kind].into();
        }
        if length > 0 {
            put("buffers", vec![json!({ "byteLength": length })]);
        }
        put("bufferViews", views);
        put("accessors", self.accessors);
        self.views
    }
}

/// Colour of an energy (J) between two limits.
pub(super) fn colour_of(total_j: f64, limits_j: [f64; 2]) -> [u8; 4] {
    CLASSES[limits_j.iter().filter(|limit| total_j >= **limit).count()]
}

/// A ball of radius 1: an octahedron cut twice.
pub(super) fn ball() -> (Vec<[f32; 3]>, Vec<u32>) {
    let mut places: Vec<[f32; 3]> = vec![
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
    ];
    let mut triangles: Vec<[u32; 3]> = vec![
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ];
    for _ in 0..2 {
        triangles = triangles.iter().flat_map(|&corners| cut(&mut places, corners)).collect();
    }
    (places, triangles.concat())
}

/// Four triangles for one, with new corners on the ball in the middle of its sides.
fn cut(places: &mut Vec<[f32; 3]>, [a, b, c]: [u32; 3]) -> [[u32; 3]; 4] {
    let mut middle = |one: u32, other: u32| {
        let sum: [f32; 3] =
            std::array::from_fn(|i| places[one as usize][i] + places[other as usize][i]);
        let length = sum.iter().map(|x| x * x).sum::<f32>().sqrt();
        // + 0 turns the zero of either sign into one
        let place = sum.map(|x| x / length + 0.0);
        // a side is shared: its middle may be there already
        places
            .iter()
            .position(|known| known.map(f32::to_bits) == place.map(f32::to_bits))
            .unwrap_or_else(|| {
                places.push(place);
                places.len() - 1
            }) as u32
    };
    let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
}

/// Head and numbers as a binary glTF file. What is written is let go: the numbers are most of the memory that a report takes.
pub(super) fn file(head: &Value, views: [Vec<u8>; 6]) -> Vec<u8> {
    const MAGIC: &[u8; 4] = b"glTF";
    const VERSION: u32 = 2;
    let head = head.to_string().into_bytes();
    let numbers: usize = views.iter().map(Vec::len).sum();
    let mut file = Vec::with_capacity(head.len() + numbers + 64);
    file.extend(MAGIC);
    file.extend(VERSION.to_le_bytes());
    let length_at = file.len();
    file.extend([0; 4]);
    let mut chunk = |kind: &[u8; 4], data: Vec<Vec<u8>>, filler: u8| {
        let length: usize = data.iter().map(Vec::len).sum();
        file.extend((length.next_multiple_of(4) as u32).to_le_bytes());
        file.extend(kind);
        for data in data {
            file.extend(data);
        }
        file.resize(file.len().next_multiple_of(4), filler);
    };
    chunk(b"JSON", vec![head], b' ');
    if numbers > 0 {
        chunk(b"BIN\0", views.into(), 0);
    }
    let length = file.len() as u32;
    file[length_at..length_at + 4].copy_from_slice(&length.to_le_bytes());
    file
}
