//! PLY meshes, text and binary of both byte orders (Turk 1994): the corners of `vertex` and the polygons of `face`.

use super::{fan, parsed, wrong};
use crate::error::Result;
use crate::rock::Vec3;
use crate::terrain::stl::{Format, Soup};
use std::path::Path;

/// Why a PLY file that ends too early is of no use.
const CUT_OFF: &str = "the file is cut off: export it again";

/// How the numbers after the header are stored.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Coding {
    Text,
    Little,
    Big,
}

/// A type of number.
#[derive(Debug, Clone, Copy, PartialEq)]
enum NumberKind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl NumberKind {
    fn named(word: &str) -> Option<Self> {
        Some(match word {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The number in bytes of little order, exactly.
    fn number(self, bytes: [u8; 8]) -> f64 {
        let [a, b, c, d, ..] = bytes;
        match self {
            Self::I8 => i8::from_le_bytes([a]).into(),
            Self::U8 => a.into(),
            Self::I16 => i16::from_le_bytes([a, b]).into(),
            Self::U16 => u16::from_le_bytes([a, b]).into(),
            Self::I32 => i32::from_le_bytes([a, b, c, d]).into(),
            Self::U32 => u32::from_le_bytes([a, b, c, d]).into(),
            Self::F32 => f32::from_le_bytes([a, b, c, d]).into(),
            Self::F64 => f64::from_le_bytes(bytes),
        }
    }
}

/// A property: a number, or a list with the type of its count first.
#[derive(Debug, Clone, PartialEq)]
struct Property {
    name: String,
    count: Option<NumberKind>,
    kind: NumberKind,
}

#[derive(Debug, Clone, PartialEq)]
struct PlyElement {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

/// Reads the bytes of a PLY file; `file` is for messages.
///
/// # Errors
/// Bytes that are no PLY, a file cut off, a number that is not finite, a face with an unknown corner, or no face.
pub fn parse(bytes: &[u8], file: &Path) -> Result<Soup> {
    let (coding, elements, body) = header(bytes, file)?;
    let mut numbers = PlyNumbers { coding, bytes, at: body, file };
    let (mut corners, mut soup) = (Vec::new(), Soup::of_format(Format::Ply));
    for element in &elements {
        match element.name.as_str() {
            "vertex" => corners = vertices(element, &mut numbers, &mut soup)?,
            "face" => faces(element, &mut numbers, &corners, &mut soup)?,
            _ => (0..element.count).try_for_each(|_| numbers.row(element, |_, _| ()))?,
        }
        // an element without properties takes no bytes: its count says nothing
    }
    if soup.facets.is_empty() {
        let remedy = "export the mesh with its faces; a cloud of points is read from LAS or LAZ";
        return Err(wrong(file, "face", "the file holds no face", remedy));
    }
    Ok(soup)
}

/// Coding, elements, and where the numbers begin.
fn header(bytes: &[u8], file: &Path) -> Result<(Coding, Vec<PlyElement>, usize)> {
    let (mut coding, mut elements, mut at) = (None, Vec::<PlyElement>::new(), 0);
    for number in 1.. {
        let Some(length) = bytes[at..].iter().position(|&byte| byte == b'\n') else {
            return Err(wrong(file, "header", "found no `end_header`", CUT_OFF));
        };
        let line = String::from_utf8_lossy(&bytes[at..at + length]).into_owned();
        at += length + 1;
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let refused = || {
            let remedy = "write PLY 1.0: `element NAME COUNT`, `property TYPE NAME`, `property list TYPE TYPE NAME`";
            wrong(file, format!("line {number}"), format!("found `{}`", line.trim()), remedy)
        };
        match words[..] {
            ["ply" | "end_header"] | ["comment" | "obj_info", ..] | [] => {}
            ["format", name, "1.0"] => {
                coding = Some(match name {
                    "ascii" => Coding::Text,
                    "binary_little_endian" => Coding::Little,
                    "binary_big_endian" => Coding::Big,
                    _ => return Err(refused()),
                });
            }
            ["element", name, count] => {
                let count = count.parse().map_err(|_| refused())?;
                elements.push(PlyElement { name: name.to_owned(), count, properties: Vec::new() });
            }
            ["property", ref rest @ ..] => {
                let property = property(rest).ok_or_else(refused)?;
                elements.last_mut().ok_or_else(refused)?.properties.push(property);
            }
            _ => return Err(refused()),
        }
        if words == ["end_header"] {
            break;
        }
    }
    let Some(coding) = coding else {
        return Err(wrong(
            file,
            "header",
            "found no `format`",
            "write `format ascii 1.0` or a binary one",
        ));
    };
    elements.retain(|element| !element.properties.is_empty());
    Ok((coding, elements, at))
}

fn property(words: &[&str]) -> Option<Property> {
    match *words {
        ["list", count, kind, name] => Some(Property {
            name: name.to_owned(),
            count: Some(NumberKind::named(count)?),
            kind: NumberKind::named(kind)?,
        }),
        [kind, name] => {
            Some(Property { name: name.to_owned(), count: None, kind: NumberKind::named(kind)? })
        }
        _ => None,
    }
}

fn vertices(element: &PlyElement, numbers: &mut PlyNumbers, soup: &mut Soup) -> Result<Vec<Vec3>> {
    let axis = |name: &str| element.properties.iter().position(|property| property.name == name);
    let (Some(x), Some(y), Some(z)) = (axis("x"), axis("y"), axis("z")) else {
        let remedy = "write the properties x, y and z of every vertex";
        return Err(wrong(numbers.file, "element vertex", "found no x, y, z", remedy));
    };
    let narrow = element.properties[x].kind != NumberKind::F64;
    soup.is_single = numbers.coding != Coding::Text && narrow;
    let mut corners = Vec::new();
    for number in 1..=element.count {
        let mut corner = Vec3::zeros();
        numbers.row(element, |property, (value, word)| {
            for (axis, place) in [x, y, z].into_iter().enumerate() {
                if property == place {
                    corner[axis] = value;
                    soup.last_digits.see(axis, word);
                }
            }
        })?;
        if !corner.iter().all(|x| x.is_finite()) {
            let found = format!("({}, {}, {}) is not finite", corner.x, corner.y, corner.z);
            let remedy = "repair the mesh where it was made";
            return Err(wrong(numbers.file, format!("vertex {number}"), found, remedy));
        }
        corners.push(corner);
    }
    Ok(corners)
}

fn faces(
    element: &PlyElement,
    numbers: &mut PlyNumbers,
    corners: &[Vec3],
    soup: &mut Soup,
) -> Result<()> {
    let is_ring = |property: &Property| {
        property.count.is_some()
            && ["vertex_indices", "vertex_index"].contains(&property.name.as_str())
    };
    let Some(ring) = element.properties.iter().position(is_ring) else {
        let remedy = "write `property list uchar int vertex_indices`";
        return Err(wrong(numbers.file, "element face", "found no vertex_indices", remedy));
    };
    let mut around = Vec::new();
    for number in 1..=element.count {
        around.clear();
        numbers.row(element, |property, (value, _)| {
            if property == ring {
                around.push(value);
            }
        })?;
        // negative numbers turn to 0 when cast, hence the comparison
        let corner = |&index: &f64| corners.get(index as usize).filter(|_| index >= 0.0).copied();
        let polygon: Option<Vec<Vec3>> = around.iter().map(corner).collect();
        let Some(polygon) = polygon else {
            let found = format!("found a corner that is none of {} vertices", corners.len());
            let remedy = "number vertices from 0, and write `element vertex` before `element face`";
            return Err(wrong(numbers.file, format!("face {number}"), found, remedy));
        };
        soup.facets.extend(fan(&polygon));
    }
    Ok(())
}

/// The numbers behind the header, one after the other.
struct PlyNumbers<'a> {
    coding: Coding,
    bytes: &'a [u8],
    at: usize,
    file: &'a Path,
}

/// A value, and the word that a text has for it; of bytes an empty one.
type Written<'a> = (f64, &'a [u8]);

impl<'a> PlyNumbers<'a> {
    /// One row of an element; `take` gets the number of the property and the value, list entries one by one.
    fn row(
        &mut self,
        element: &PlyElement,
        mut take: impl FnMut(usize, Written<'a>),
    ) -> Result<()> {
        for (number, property) in element.properties.iter().enumerate() {
            let count = match property.count {
                None => 1.0,
                Some(kind) => self.next(kind, element)?.0,
            };
            // a negative or enormous count ends with the bytes
            for _ in 0..count as u64 {
                take(number, self.next(property.kind, element)?);
            }
        }
        Ok(())
    }

    fn next(&mut self, kind: NumberKind, element: &PlyElement) -> Result<Written<'a>> {
        let cut_off = || {
            let place = format!("element {}", element.name);
            wrong(self.file, place, "found the end of the file", CUT_OFF)
        };
        if self.coding == Coding::Text {
            let rest: &'a [u8] = &self.bytes[self.at..];
            let start =
                rest.iter().position(|byte| !byte.is_ascii_whitespace()).ok_or_else(cut_off)?;
            let length = rest[start..]
                .iter()
                .position(u8::is_ascii_whitespace)
                .unwrap_or(rest.len() - start);
            let word = &rest[start..start + length];
            self.at += start + length;
            let value = parsed(word).ok_or_else(|| {
                let found = format!("`{}` is no number", String::from_utf8_lossy(word));
                wrong(
                    self.file,
                    format!("element {}", element.name),
                    found,
                    "write numbers like 1063.95",
                )
            })?;
            return Ok((value, word));
        }
        let taken = self.bytes.get(self.at..self.at + kind.bytes()).ok_or_else(cut_off)?;
        let mut little = [0; 8];
        little[..taken.len()].copy_from_slice(taken);
        if self.coding == Coding::Big {
            little[..taken.len()].reverse();
        }
        self.at += kind.bytes();
        Ok((kind.number(little), b""))
    }
}
