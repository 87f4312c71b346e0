//! `GeoTIFF` files written byte by byte, so that every layout and packing can be tried without another program.

#![allow(missing_docs, dead_code, unreachable_pub, clippy::unwrap_used)]

use std::io::Write;

/// A type of sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    U8,
    U16,
    I16,
    U32,
    I32,
    F32,
    F64,
}

impl Kind {
    pub const ALL: [Self; 7] =
        [Self::U8, Self::U16, Self::I16, Self::U32, Self::I32, Self::F32, Self::F64];

    pub fn bytes(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::U32 | Self::I32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// Unsigned, signed, floating point.
    fn format(self) -> u16 {
        match self {
            Self::U8 | Self::U16 | Self::U32 => 1,
            Self::I16 | Self::I32 => 2,
            Self::F32 | Self::F64 => 3,
        }
    }

    pub fn is_float(self) -> bool {
        self.format() == 3
    }

    /// The bits of a value in little order.
    fn bits(self, value: f64) -> Vec<u8> {
        match self {
            Self::U8 => (value as u8).to_le_bytes().to_vec(),
            Self::U16 => (value as u16).to_le_bytes().to_vec(),
            Self::I16 => (value as i16).to_le_bytes().to_vec(),
            Self::U32 => (value as u32).to_le_bytes().to_vec(),
            Self::I32 => (value as i32).to_le_bytes().to_vec(),
            Self::F32 => (value as f32).to_le_bytes().to_vec(),
            Self::F64 => value.to_le_bytes().to_vec(),
        }
    }

    /// What of a value the type can hold.
    pub fn kept(self, value: f64) -> f64 {
        match self {
            Self::U8 => (value as u8).into(),
            Self::U16 => (value as u16).into(),
            Self::I16 => (value as i16).into(),
            Self::U32 => (value as u32).into(),
            Self::I32 => (value as i32).into(),
            Self::F32 => (value as f32).into(),
            Self::F64 => value,
        }
    }
}

/// TIFF's numbers of packings.
pub const PLAIN: u16 = 1;
pub const LZW: u16 = 5;
pub const DEFLATE: u16 = 8;
pub const PACK_BITS: u16 = 32_773;

/// How an image is stored.
#[derive(Debug, Clone)]
pub struct Spec {
    pub kind: Kind,
    pub size: [usize; 2],
    pub big_endian: bool,
    pub big_tiff: bool,
    /// Tiles of this size, or strips of so many rows.
    pub tile: Option<[usize; 2]>,
    pub rows_per_strip: usize,
    pub packing: u16,
    pub predictor: u16,
    pub scale: Vec<f64>,
    pub tie: Vec<f64>,
    pub matrix: Vec<f64>,
    pub keys: Vec<u16>,
    pub nodata: Option<String>,
    pub metadata: Option<String>,
    /// Directories in front of the data, as in a cloud-optimised file.
    pub ahead: bool,
}

impl Spec {
    /// Cells of 2 m, EPSG:2056, pixel is area.
    pub fn new(kind: Kind, size: [usize; 2]) -> Self {
        Self {
            kind,
            size,
            big_endian: false,
            big_tiff: false,
            tile: None,
            rows_per_strip: size[1],
            packing: PLAIN,
            predictor: 1,
            scale: vec![2.0, 2.0, 0.0],
            tie: vec![0.0, 0.0, 0.0, 2_600_000.5, 1_200_100.25, 0.0],
            matrix: Vec::new(),
            keys: vec![1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 2056],
            nodata: None,
            metadata: None,
            ahead: false,
        }
    }

    /// The parts of the image: corner, size, size with filling.
    fn chunks(&self) -> Vec<([usize; 2], [usize; 2], [usize; 2])> {
        let [width, height] = self.size;
        let [wide, high] = self.tile.unwrap_or([width, self.rows_per_strip]);
        let mut chunks = Vec::new();
        for y in (0..height).step_by(high) {
            for x in (0..width).step_by(wide) {
                let inside = [wide.min(width - x), high.min(height - y)];
                let whole = if self.tile.is_some() { [wide, high] } else { inside };
                chunks.push(([x, y], inside, whole));
            }
        }
        chunks
    }

    /// The bytes of a part: predicted, ordered, packed.
    fn pack(
        &self,
        value: &dyn Fn(usize, usize) -> f64,
        chunk: ([usize; 2], [usize; 2], [usize; 2]),
    ) -> Vec<u8> {
        let ([x, y], inside, [wide, high]) = chunk;
        let mut bytes = Vec::new();
        for row in 0..high {
            let sample = |column: usize| {
                let held = column < inside[0] && row < inside[1];
                self.kind.bits(if held { value(x + column, y + row) } else { 7.0 })
            };
            bytes.extend(self.row(&(0..wide).map(sample).collect::<Vec<_>>()));
        }
        match self.packing {
            PLAIN => bytes,
            LZW => weezl::encode::Encoder::with_tiff_size_switch(weezl::BitOrder::Msb, 8)
                .encode(&bytes)
                .unwrap(),
            DEFLATE => {
                let mut to =
                    flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
                to.write_all(&bytes).unwrap();
                to.finish().unwrap()
            }
            _ => bytes
                .chunks(128)
                .flat_map(|run| std::iter::once(run.len() as u8 - 1).chain(run.iter().copied()))
                .collect(),
        }
    }

    fn row(&self, samples: &[Vec<u8>]) -> Vec<u8> {
        let bytes = self.kind.bytes();
        if self.predictor == 3 {
            // the most significant bytes first, then the next ones …, then differences of bytes
            let planes =
                (1..=bytes).flat_map(|k| samples.iter().map(move |sample| sample[bytes - k]));
            let plain: Vec<u8> = planes.collect();
            return (0..plain.len())
                .map(|k| if k == 0 { plain[0] } else { plain[k].wrapping_sub(plain[k - 1]) })
                .collect();
        }
        let number =
            |sample: &[u8]| sample.iter().rev().fold(0u64, |all, &byte| all << 8 | u64::from(byte));
        let mut row = Vec::new();
        for k in 0..samples.len() {
            let before = if self.predictor == 2 && k > 0 { number(&samples[k - 1]) } else { 0 };
            let mut little =
                number(&samples[k]).wrapping_sub(before).to_le_bytes()[..bytes].to_vec();
            if self.big_endian {
                little.reverse();
            }
            row.extend(little);
        }
        row
    }
}

/// A value of a directory.
enum Field {
    Short(Vec<u16>),
    Long(Vec<u64>),
    Double(Vec<f64>),
    Ascii(String),
}

/// An image and what its heights are.
pub type Image<'a> = (&'a Spec, &'a dyn Fn(usize, usize) -> f64);

/// A file of one image and its overviews.
pub fn write(images: &[Image]) -> Vec<u8> {
    let (big, order) = (images[0].0.big_tiff, images[0].0.big_endian);
    let head = if big { 16 } else { 8 };
    let packed: Vec<Vec<Vec<u8>>> = images
        .iter()
        .map(|(spec, value)| {
            spec.chunks().into_iter().map(|chunk| spec.pack(value, chunk)).collect()
        })
        .collect();
    let data: usize = packed.iter().flatten().map(Vec::len).sum();
    let directories = |at: usize, data_at: usize| -> Vec<u8> {
        let (mut bytes, mut offset) = (Vec::new(), data_at);
        for (number, ((spec, _), chunks)) in images.iter().zip(&packed).enumerate() {
            let mut offsets = Vec::new();
            for chunk in chunks {
                offsets.push(offset as u64);
                offset += chunk.len();
            }
            let counts = chunks.iter().map(|chunk| chunk.len() as u64).collect();
            let fields = fields(spec, number > 0, offsets, counts);
            let is_last = number + 1 == images.len();
            bytes.extend(directory(&fields, at + bytes.len(), (big, order), is_last));
        }
        bytes
    };
    let length = directories(0, 0).len();
    let (first, data_at) =
        if images[0].0.ahead { (head, head + length) } else { (head + data, head) };
    let mut file = if order { b"MM".to_vec() } else { b"II".to_vec() };
    let mut put = |value: u64, bytes: usize| file.extend(ordered(value, bytes, order));
    put(if big { 43 } else { 42 }, 2);
    if big {
        put(8, 2);
        put(0, 2);
    }
    put(first as u64, if big { 8 } else { 4 });
    let directories = directories(first, data_at);
    let data = packed.into_iter().flatten().flatten();
    if images[0].0.ahead {
        file.extend(directories);
        file.extend(data);
    } else {
        file.extend(data);
        file.extend(directories);
    }
    file
}

fn ordered(value: u64, bytes: usize, big_endian: bool) -> Vec<u8> {
    let mut all = value.to_le_bytes()[..bytes].to_vec();
    if big_endian {
        all.reverse();
    }
    all
}

fn fields(
    spec: &Spec,
    is_overview: bool,
    offsets: Vec<u64>,
    counts: Vec<u64>,
) -> Vec<(u16, Field)> {
    let long = |value: usize| Field::Long(vec![value as u64]);
    let short = |value: u16| Field::Short(vec![value]);
    let mut fields = vec![
        (254, long(usize::from(is_overview))),
        (256, long(spec.size[0])),
        (257, long(spec.size[1])),
        (258, short(8 * spec.kind.bytes() as u16)),
        (259, short(spec.packing)),
        (262, short(1)),
        (277, short(1)),
        (317, short(spec.predictor)),
        (339, short(spec.kind.format())),
    ];
    match spec.tile {
        Some([wide, high]) => fields.extend([
            (322, long(wide)),
            (323, long(high)),
            (324, Field::Long(offsets)),
            (325, Field::Long(counts)),
        ]),
        None => fields.extend([
            (273, Field::Long(offsets)),
            (278, long(spec.rows_per_strip)),
            (279, Field::Long(counts)),
        ]),
    }
    if !is_overview {
        let doubles = [(33_550, &spec.scale), (33_922, &spec.tie), (34_264, &spec.matrix)];
        let given = doubles.into_iter().filter(|(_, list)| !list.is_empty());
        fields.extend(given.map(|(tag, list)| (tag, Field::Double(list.clone()))));
        if !spec.keys.is_empty() {
            fields.push((34_735, Field::Short(spec.keys.clone())));
        }
        let texts = [(42_112, &spec.metadata), (42_113, &spec.nodata)];
        fields.extend(
            texts.into_iter().filter_map(|(tag, text)| Some((tag, Field::Ascii(text.clone()?)))),
        );
    }
    fields.sort_by_key(|(tag, _)| *tag);
    fields
}

/// One directory with its long values behind it.
fn directory(
    fields: &[(u16, Field)],
    at: usize,
    (big, order): (bool, bool),
    is_last: bool,
) -> Vec<u8> {
    let (count_bytes, entry_bytes, room) = if big { (8, 20, 8) } else { (2, 12, 4) };
    let table = count_bytes + entry_bytes * fields.len() + room;
    let (mut entries, mut behind) = (ordered(fields.len() as u64, count_bytes, order), Vec::new());
    for (tag, field) in fields {
        let (kind, count, bytes): (u64, usize, Vec<u8>) = match field {
            Field::Short(all) => {
                (3, all.len(), all.iter().flat_map(|&x| ordered(x.into(), 2, order)).collect())
            }
            Field::Long(all) if big => {
                (16, all.len(), all.iter().flat_map(|&x| ordered(x, 8, order)).collect())
            }
            Field::Long(all) => {
                (4, all.len(), all.iter().flat_map(|&x| ordered(x, 4, order)).collect())
            }
            Field::Double(all) => {
                (12, all.len(), all.iter().flat_map(|x| ordered(x.to_bits(), 8, order)).collect())
            }
            Field::Ascii(text) => (2, text.len() + 1, text.bytes().chain([0]).collect()),
        };
        entries.extend(ordered((*tag).into(), 2, order));
        entries.extend(ordered(kind, 2, order));
        entries.extend(ordered(count as u64, room, order));
        if bytes.len() <= room {
            entries.extend(bytes.iter().copied().chain(std::iter::repeat(0)).take(room));
        } else {
            entries.extend(ordered((at + table + behind.len()) as u64, room, order));
            behind.extend(bytes);
        }
    }
    let next = if is_last { 0 } else { at + table + behind.len() };
    entries.extend(ordered(next as u64, room, order));
    entries.extend(behind);
    entries
}
