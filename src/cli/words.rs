//! Words of the command line: those that are numbers, and how one is written again.

use crate::run::Selection;
use crate::scene::MOST_RELEASES;
use crate::terrain::weld::Up;

/// Most releases of one trial of a calibration: the ends of all trials are kept.
const MOST_OF_A_TRIAL: usize = 100_000;

/// Most worker threads: more than any machine has; a slip of the key must not start a hundred thousand.
const MOST_THREADS: usize = 4096;

pub(super) fn shard(text: &str) -> std::result::Result<Selection, String> {
    let numbers = text.split_once('/').map(|(number, of)| (number.parse(), of.parse()));
    match numbers {
        Some((Ok(number), Ok(of))) if (1..=of).contains(&number) => {
            Ok(Selection::Shard { number, of })
        }
        _ => Err("write K/N, K from 1 to N: 3/16 is the third of 16 parts".to_owned()),
    }
}

pub(super) fn threads(text: &str) -> std::result::Result<usize, String> {
    match text.parse() {
        Ok(number) if (1..=MOST_THREADS).contains(&number) => Ok(number),
        _ => Err(format!("write a whole number from 1 to {MOST_THREADS}")),
    }
}

pub(super) fn of_a_trial(text: &str) -> std::result::Result<usize, String> {
    match text.parse() {
        Ok(number) if (1..=MOST_OF_A_TRIAL).contains(&number) => Ok(number),
        _ => Err(format!("write a whole number from 1 to {MOST_OF_A_TRIAL}")),
    }
}

pub(super) fn at_least_1(text: &str) -> std::result::Result<usize, String> {
    match text.parse() {
        Ok(number) if (1..=MOST_RELEASES).contains(&number) => Ok(number),
        _ => Err(format!("write a whole number from 1 to {MOST_RELEASES}")),
    }
}

pub(super) fn up(text: &str) -> std::result::Result<Up, String> {
    match text {
        "z" => Ok(Up::Z),
        "y" => Ok(Up::Y),
        _ => Err("write z or y".to_owned()),
    }
}

/// A word as a shell takes it for one.
pub(super) fn quoted(word: &str) -> String {
    let plain = |letter: char| letter.is_alphanumeric() || "-_./=,:+%@".contains(letter);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}
