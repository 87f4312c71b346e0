//! Random numbers: counter-based random streams and the distributions a scene may draw from.
//!
//! Randomness belongs to the rock, not to the thread: a stream is named by seed, purpose and release number,
//! and nothing else decides its values. One draw takes exactly one 64-bit word of its stream, whatever the
//! distribution, so that giving one key a distribution leaves the draws of all others alone.

mod distribution;
mod entries;
mod normal;
mod written;

pub use distribution::{Distribution, LARGEST, LEAST};
pub use entries::{Entries, entries};

use chacha20::ChaCha8Rng;
use chacha20::rand_core::{Rng, SeedableRng};

/// A stream of random words. `ChaCha8` is counter-based and specified to the bit.
#[derive(Debug)]
pub struct RandomStream(ChaCha8Rng);

impl RandomStream {
    fn of(key: [u8; 32], number: u64) -> Self {
        let mut words = ChaCha8Rng::from_seed(key);
        words.set_stream(number);
        Self(words)
    }
}

/// The same stream from the same word on: a rock that is followed anew meets what it met.
impl Clone for RandomStream {
    fn clone(&self) -> Self {
        let mut copy = Self::of(self.0.get_seed(), self.0.get_stream());
        copy.0.set_word_pos(self.0.get_word_pos());
        copy
    }
}

/// What a stream is for. Two purposes never share a word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Purpose {
    /// Where a rock is released.
    Place = 1,
    /// How large it is.
    Size = 2,
    /// Its velocity and spin at release.
    Start = 3,
    /// The ground values in force for it.
    Grounds = 4,
    /// The tilt of the contact normal at its impacts.
    Impacts = 5,
    /// Its shape and how it is turned at release.
    Shape = 8,
    /// What stems that give way can take of it.
    Stems = 7,
    /// Which rocks a statistic is computed from again, to see how far chance moves it.
    Redraw = 6,
}

/// The stream of one purpose of one release: the same alone, resumed, or among a million.
pub fn stream(seed: u64, purpose: Purpose, index: usize) -> RandomStream {
    let mut key = *b"________-rockfall random stream-";
    key[..8].copy_from_slice(&seed.to_le_bytes());
    key[8] = purpose as u8;
    RandomStream::of(key, index as u64)
}

/// The stream of another purpose of the same release.
pub fn beside(random: &RandomStream, purpose: Purpose) -> RandomStream {
    let mut key = random.0.get_seed();
    key[8] = purpose as u8;
    RandomStream::of(key, random.0.get_stream())
}

/// A number drawn evenly from the open interval (0, 1), never 0 or 1, symmetric about 1/2 (–).
///
/// `(k + 1/2) 2⁻⁵²` with `k` the upper 52 bits of one word: exact in `f64`.
pub fn unit(random: &mut RandomStream) -> f64 {
    const STEP: f64 = 1.0 / (1_u64 << 52) as f64;
    ((random.0.next_u64() >> 12) as f64 + 0.5) * STEP
}

/// One of so many, of which there must be one, drawn evenly: its number, from 0.
pub fn one_of(random: &mut RandomStream, count: usize) -> usize {
    ((unit(random) * count as f64) as usize).min(count - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first_words(seed: u64, purpose: Purpose, index: usize) -> [u64; 4] {
        let mut random = stream(seed, purpose, index);
        std::array::from_fn(|_| random.0.next_u64())
    }

    /// A stream is a function of its name alone, and no two names share it.
    #[test]
    fn every_seed_purpose_and_release_has_a_stream_of_its_own() {
        let names = [
            (7, Purpose::Place, 0),
            (8, Purpose::Place, 0),
            (7, Purpose::Size, 0),
            (7, Purpose::Place, 1),
            (7, Purpose::Place, 1_000_000),
        ];
        let words = names.map(|(seed, purpose, index)| first_words(seed, purpose, index));
        for (i, one) in words.iter().enumerate() {
            assert!(words[i + 1..].iter().all(|other| other != one));
        }
        assert_eq!(words[4], first_words(7, Purpose::Place, 1_000_000));
    }

    /// Neighbouring releases are independent: the correlation of their first draws over n pairs
    /// has the standard deviation 1/√n; five of them leave one chance in 10⁶ of failing.
    #[test]
    fn neighbouring_releases_are_uncorrelated() {
        let n = 20_000;
        let draws: Vec<f64> =
            (0..=n).map(|i| unit(&mut stream(2017, Purpose::Place, i)) - 0.5).collect();
        let product: f64 = draws.windows(2).map(|pair| pair[0] * pair[1]).sum();
        let correlation = product * 12.0 / n as f64;
        assert!(correlation.abs() < 5.0 / (n as f64).sqrt(), "{correlation}");
    }

    /// A rock that is stepped anew from a state kept before must meet the facets that it met.
    #[test]
    #[expect(clippy::float_cmp, reason = "the same stream must give the same bits")]
    fn a_copy_goes_on_where_the_stream_was() {
        let mut random = stream(2017, Purpose::Impacts, 1_000_000);
        for drawn in 0..70 {
            let mut copy = random.clone();
            assert_eq!(unit(&mut copy), unit(&mut random), "after {drawn}");
        }
    }

    /// `ChaCha8` is specified to the bit and `unit` is exact: a published run can be repeated only while
    /// these two values, drawn by this version, never change.
    #[test]
    #[expect(clippy::float_cmp, reason = "the same stream must give the same bits")]
    fn draws_are_value_stable() {
        let mut random = stream(2017, Purpose::Size, 137);
        let drawn = [unit(&mut random), unit(&mut random)];
        assert_eq!(drawn, [0.620_068_286_355_674, 0.893_149_787_554_896_9]);
    }
}
