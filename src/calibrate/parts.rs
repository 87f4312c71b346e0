//! The parts that measured ends are held out in.

use crate::error::Error;
use std::path::Path;

/// Rows of each block, blocks in the order of the file; an end of no known block is one of its own.
pub(super) fn rows_of(ends: usize, blocks: &[String]) -> Vec<(&str, Vec<usize>)> {
    let mut known: Vec<(&str, Vec<usize>)> = Vec::new();
    for row in 0..ends {
        let block = blocks.get(row).map(String::as_str);
        match known.iter_mut().find(|(name, _)| block == Some(name)) {
            Some((_, rows)) => rows.push(row),
            None => known.push((block.unwrap_or_default(), vec![row])),
        }
    }
    known
}

/// The part that each measured end is held out with: throws of one block together, each block where there are fewest so
/// far. None where there are fewer blocks than parts.
pub(super) fn parts_of(ends: usize, blocks: &[String], parts: usize) -> Option<Vec<usize>> {
    let known = rows_of(ends, blocks);
    let mut sizes = vec![0; parts];
    let mut part = vec![0; ends];
    for (_, rows) in &known {
        let least = (0..parts).min_by_key(|&part| sizes[part])?;
        sizes[least] += rows.len();
        for &row in rows {
            part[row] = least;
        }
    }
    sizes.iter().all(|size| *size > 0).then_some(part)
}

/// Complains about blocks that do not suffice for so many parts.
pub(super) fn few(deposits: &Path, parts: usize) -> Error {
    let found = format!("found fewer blocks than the {parts} parts that held_out asks for");
    let remedy = "write ends of more blocks, or held_out = 0.0, which holds none out";
    Error::input(deposits, "rows", found, remedy)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Seven throws of three blocks in two parts: no block in both, and the parts as even as they can be.
    #[test]
    fn throws_of_one_block_are_held_out_together() {
        let blocks = ["a", "b", "a", "c", "a", "b", "c"].map(str::to_owned);
        assert_eq!(parts_of(7, &blocks, 2), Some(vec![0, 1, 0, 1, 0, 1, 1]));
        assert_eq!(parts_of(7, &blocks, 4), None);
        assert_eq!(parts_of(5, &[], 2), Some(vec![0, 1, 0, 1, 0]));
    }
}
