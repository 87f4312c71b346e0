//! What the glTF 2.0 specification asks of a binary file.

use serde_json::Value;

/// Checks header, chunks, views, accessors, least and largest values, root and animation.
pub(crate) fn check(file: &[u8]) {
    let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&file[..4], word(4), word(8)), (&b"glTF"[..], 2, file.len()));
    let length = word(12);
    assert_eq!((&file[16..20], length % 4), (&b"JSON"[..], 0));
    let head: Value = serde_json::from_slice(&file[20..20 + length]).unwrap();
    let start = 20 + length;
    assert_eq!(&file[start + 4..start + 8], b"BIN\0");
    let bin = &file[start + 8..];
    assert_eq!((bin.len(), bin.len() % 4), (word(start), 0));
    let number = |value: &Value| value.as_u64().unwrap() as usize;
    let buffer = number(&head["buffers"][0]["byteLength"]);
    assert!(buffer <= bin.len() && bin.len() - buffer < 4);
    for accessor in head["accessors"].as_array().unwrap() {
        let view = &head["bufferViews"][number(&accessor["bufferView"])];
        let parts = match accessor["type"].as_str().unwrap() {
            "SCALAR" => 1,
            "VEC3" => 3,
            other => {
                assert_eq!(other, "VEC4");
                4
            }
        };
        let size = match number(&accessor["componentType"]) {
            5121 => 1,
            5125 | 5126 => 4,
            other => panic!("component type {other}"),
        };
        let (count, from) = (number(&accessor["count"]), number(&accessor["byteOffset"]));
        assert!(count > 0 && from % size == 0);
        assert!(from + count * parts * size <= number(&view["byteLength"]), "{accessor}");
        assert!(view["byteStride"].is_null() || number(&view["byteStride"]) == parts * size);
        let start = number(&view["byteOffset"]) + from;
        assert!(start + count * parts * size <= buffer);
        if number(&accessor["componentType"]) == 5126 {
            check_box(accessor, &bin[start..start + count * parts * 4], parts);
        }
    }
    check_indices(&head, bin);
    let root = &head["nodes"][number(&head["scenes"][0]["nodes"][0])];
    let half = std::f64::consts::FRAC_1_SQRT_2;
    assert_eq!(root["rotation"], serde_json::json!([-half, 0.0, 0.0, half]));
    for animation in head["animations"].as_array().into_iter().flatten() {
        for channel in animation["channels"].as_array().unwrap() {
            let node = &head["nodes"][number(&channel["target"]["node"])];
            assert!(node["name"].as_str().unwrap().starts_with("rock "));
            let sampler = &animation["samplers"][number(&channel["sampler"])];
            let count = |what: &str| &head["accessors"][number(&sampler[what])]["count"];
            assert_eq!(count("input"), count("output"));
            // in 32 bits too
            let times = Scene::read(file).numbers::<1>(&sampler["input"]);
            assert!(times.is_sorted_by(|one, next| one < next), "{times:?}");
        }
    }
}

/// What is in a file.
pub(crate) struct Scene<'a> {
    head: Value,
    bin: &'a [u8],
}

impl<'a> Scene<'a> {
    pub(crate) fn read(file: &'a [u8]) -> Self {
        let length = u32::from_le_bytes(file[12..16].try_into().unwrap()) as usize;
        let head = serde_json::from_slice(&file[20..20 + length]).unwrap();
        Self { head, bin: &file[28 + length..] }
    }

    /// The node of a name.
    pub(crate) fn node(&self, name: &str) -> &Value {
        self.head["nodes"].as_array().unwrap().iter().find(|node| node["name"] == name).unwrap()
    }

    fn numbers<const N: usize>(&self, accessor: &Value) -> Vec<[f32; N]> {
        let number = |value: &Value| value.as_u64().unwrap() as usize;
        let accessor = &self.head["accessors"][number(accessor)];
        let view = &self.head["bufferViews"][number(&accessor["bufferView"])];
        let start = number(&view["byteOffset"]) + number(&accessor["byteOffset"]);
        let bytes = &self.bin[start..start + 4 * N * number(&accessor["count"])];
        let (words, _) = bytes.as_chunks::<4>();
        let numbers: Vec<f32> = words.iter().map(|word| f32::from_le_bytes(*word)).collect();
        numbers.as_chunks::<N>().0.to_vec()
    }

    /// Corners of the mesh of a node.
    pub(crate) fn places_of(&self, node: &Value) -> Vec<[f32; 3]> {
        let mesh = node["mesh"].as_u64().unwrap() as usize;
        self.numbers(&self.head["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"])
    }

    /// Times and attitudes of the keyframes of a node.
    pub(crate) fn rotation_of(&self, node: &Value) -> (Vec<f32>, Vec<[f32; 4]>) {
        let animation = &self.head["animations"][0];
        let nodes = self.head["nodes"].as_array().unwrap();
        let is_own = |channel: &&Value| {
            let target = channel["target"]["node"].as_u64().unwrap() as usize;
            nodes[target] == *node && channel["target"]["path"] == "rotation"
        };
        let channel = animation["channels"].as_array().unwrap().iter().find(is_own).unwrap();
        let sampler = &animation["samplers"][channel["sampler"].as_u64().unwrap() as usize];
        assert_eq!(sampler["interpolation"], "LINEAR");
        let times = self.numbers::<1>(&sampler["input"]).concat();
        (times, self.numbers(&sampler["output"]))
    }
}

/// `min` and `max` are those of the numbers, to the bit.
fn check_box(accessor: &Value, bytes: &[u8], parts: usize) {
    let (numbers, _) = bytes.as_chunks::<4>();
    let numbers: Vec<f32> = numbers.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
    for part in 0..parts {
        let own = numbers.iter().skip(part).step_by(parts);
        let (low, high) =
            own.fold((f32::INFINITY, f32::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
        let said = |what: &str| accessor[what][part].as_f64().unwrap() as f32;
        assert_eq!([said("min"), said("max")].map(f32::to_bits), [low, high].map(f32::to_bits));
    }
}

/// No triangle has a corner that is not there.
fn check_indices(head: &Value, bin: &[u8]) {
    let number = |value: &Value| value.as_u64().unwrap() as usize;
    let primitives = head["meshes"].as_array().into_iter().flatten();
    for primitive in primitives.flat_map(|mesh| mesh["primitives"].as_array().unwrap()) {
        let count =
            number(&head["accessors"][number(&primitive["attributes"]["POSITION"])]["count"]);
        if primitive["indices"].is_null() {
            assert_eq!(primitive["mode"], 3);
            continue;
        }
        let accessor = &head["accessors"][number(&primitive["indices"])];
        let view = &head["bufferViews"][number(&accessor["bufferView"])];
        let start = number(&view["byteOffset"]) + number(&accessor["byteOffset"]);
        let all = number(&accessor["count"]);
        assert!(primitive["mode"] == 4 && all % 3 == 0);
        let (corners, _) = bin[start..start + 4 * all].as_chunks::<4>();
        assert!(corners.iter().all(|v| (u32::from_le_bytes(*v) as usize) < count));
    }
}
