//! Columns of whole numbers, packed small enough to stand as text in a page.
//!
//! ```text
//! numbers ─► differences (modulo 2^bits) ─► folded sign ─► planes of bytes ─► deflate ─► base64
//! ```
//!
//! A section is a head (JSON: columns and facts) and the planes of all columns one after the other. Whoever reads it
//! takes the columns that it knows by name: further ones (how a block has turned, for instance) may be added at any time.
//! The same is read by `web/decode.js`.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use serde::{Deserialize, Serialize};
use std::io::{Read, Write};

/// One column: `count` items of `parts` numbers each.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PackedColumn {
    /// Its name.
    pub name: String,
    /// Number of items.
    pub count: usize,
    /// Numbers an item (3 for a place).
    pub parts: usize,
    /// Bytes a number, 1 to 4.
    pub bytes: u32,
    /// 0: the numbers as they are, 1: first differences, 2: second differences (a parabola becomes a constant).
    pub order: u32,
}

#[derive(Serialize, Deserialize)]
struct Head {
    columns: Vec<PackedColumn>,
    facts: serde_json::Value,
}

/// A section being packed, or read back.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Section {
    /// What must be known besides the columns.
    pub facts: serde_json::Value,
    columns: Vec<(PackedColumn, Vec<u32>)>,
}

impl Section {
    /// A section with these facts and no column.
    pub fn new(facts: serde_json::Value) -> Self {
        Self { facts, columns: Vec::new() }
    }

    /// Adds a column of `parts` numbers an item, as wide as its largest number needs.
    pub fn add(&mut self, name: &str, parts: usize, order: u32, numbers: Vec<u32>) {
        let most = numbers.iter().copied().max().unwrap_or(0);
        let bytes = (1..4).find(|bytes| most >> (8 * bytes) == 0).unwrap_or(4);
        let count = numbers.len() / parts;
        self.columns
            .push((PackedColumn { name: name.to_owned(), count, parts, bytes, order }, numbers));
    }

    /// The numbers of a column, item by item; none of that name gives none.
    pub fn numbers(&self, name: &str) -> &[u32] {
        let found = self.columns.iter().find(|(column, _)| column.name == name);
        found.map_or(&[], |(_, numbers)| numbers)
    }

    /// Packed as text.
    pub fn text(&self) -> String {
        let head = Head {
            columns: self.columns.iter().map(|(column, _)| column.clone()).collect(),
            facts: self.facts.clone(),
        };
        // writing to memory cannot fail, nor do these types hold what JSON cannot
        let head = serde_json::to_vec(&head).unwrap_or_default();
        let mut raw = (head.len() as u32).to_le_bytes().to_vec();
        raw.extend(&head);
        for (column, numbers) in &self.columns {
            append_planes(column, numbers, &mut raw);
        }
        let mut packed = ZlibEncoder::new(Vec::new(), Compression::default());
        let written = packed.write_all(&raw).and_then(|()| packed.finish());
        STANDARD.encode(written.unwrap_or_default())
    }

    /// Reads a section back; none when the text is none.
    pub fn read(text: &str) -> Option<Self> {
        let packed = STANDARD.decode(text.trim()).ok()?;
        let mut raw = Vec::new();
        ZlibDecoder::new(packed.as_slice()).read_to_end(&mut raw).ok()?;
        let (length, rest) = raw.split_first_chunk::<4>()?;
        let (head, mut planes) = rest.split_at_checked(u32::from_le_bytes(*length) as usize)?;
        let head: Head = serde_json::from_slice(head).ok()?;
        let mut columns = Vec::new();
        for column in head.columns {
            let numbers = take_planes(&column, &mut planes)?;
            columns.push((column, numbers));
        }
        Some(Self { facts: head.facts, columns })
    }
}

/// What the numbers before lead to expect.
fn expected(order: u32, before: [u32; 2]) -> u32 {
    match order {
        0 => 0,
        1 => before[0],
        _ => before[0].wrapping_mul(2).wrapping_sub(before[1]),
    }
}

/// A difference with its sign folded into the lowest bit: small ones of either sign stay small.
fn folded(difference: u32, bytes: u32) -> u32 {
    let spare = 32 - 8 * bytes;
    let signed = (difference << spare).cast_signed() >> spare;
    ((signed << 1) ^ (signed >> 31)).cast_unsigned()
}

fn unfolded(folded: u32) -> u32 {
    (folded >> 1) ^ (folded & 1).wrapping_neg()
}

fn append_planes(column: &PackedColumn, numbers: &[u32], raw: &mut Vec<u8>) {
    let PackedColumn { parts, bytes, order, .. } = *column;
    for part in 0..parts {
        let mut before = [0, 0];
        let coded: Vec<u32> = numbers[part.min(numbers.len())..]
            .iter()
            .step_by(parts)
            .map(|&number| {
                let difference = number.wrapping_sub(expected(order, before));
                before = [number, if before == [0, 0] { number } else { before[0] }];
                if order == 0 { number } else { folded(difference, bytes) }
            })
            .collect();
        for plane in 0..bytes {
            raw.extend(coded.iter().map(|code| (code >> (8 * plane)) as u8));
        }
    }
}

fn take_planes(column: &PackedColumn, planes: &mut &[u8]) -> Option<Vec<u32>> {
    let PackedColumn { count, parts, bytes, order, .. } = *column;
    if !(1..=4).contains(&bytes) {
        return None;
    }
    let all = count.checked_mul(parts)?;
    let (own, rest) = planes.split_at_checked(all.checked_mul(bytes as usize)?)?;
    *planes = rest;
    let mask = u32::MAX >> (32 - 8 * bytes);
    let mut numbers = vec![0; all];
    for part in 0..parts {
        let start = part * count * bytes as usize;
        let mut before = [0, 0];
        for item in 0..count {
            let byte = |plane: usize| u32::from(own[start + plane * count + item]) << (8 * plane);
            let code: u32 = (0..bytes as usize).map(byte).sum();
            let number = match order {
                0 => code,
                _ => expected(order, before).wrapping_add(unfolded(code)) & mask,
            };
            before = [number, if before == [0, 0] { number } else { before[0] }];
            numbers[item * parts + part] = number;
        }
    }
    Some(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Whatever the numbers: nothing is clipped, nothing is lost.
        #[test]
        fn what_is_packed_is_read_back(
            numbers in prop::collection::vec(any::<u32>(), 0..60),
            bits in 1_u32..33,
            order in 0_u32..3,
        ) {
            let numbers: Vec<u32> = numbers.iter().map(|n| n >> (32 - bits)).collect();
            let whole = numbers.len() / 3 * 3;
            let mut section = Section::new(serde_json::json!({ "a": 1 }));
            section.add("places", 3, order, numbers[..whole].to_vec());
            section.add("others", 1, order, numbers);
            prop_assert_eq!(Section::read(&section.text()), Some(section));
        }
    }

    /// A parabola of 500 points costs next to nothing.
    #[test]
    fn a_flight_packs_to_almost_nothing() {
        let height = |k: u32| 100_000 - 3 * k * k / 20;
        let mut section = Section::default();
        section.add("z", 1, 2, (0..500).map(height).collect());
        assert!(section.text().len() < 500, "{}", section.text().len());
    }

    #[test]
    fn text_that_is_no_section_is_none() {
        for text in ["", "AAAA", "not base64!", "eJwDAAAAAAE="] {
            assert_eq!(Section::read(text), None, "{text}");
        }
    }
}
