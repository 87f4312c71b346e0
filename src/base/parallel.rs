//! Loops over numbered things on all threads.
//!
//! The loop itself is compiled once, whatever runs in it: rayon's own adaptors come anew with every closure, and were a
//! quarter of the code that the compiler had to make for the terrain. Things are numbered from 0; what is gathered stands in the order
//! of the numbers, on any number of threads.

use rayon::iter::{IntoParallelIterator, ParallelIterator};
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// Things that one thread takes at once.
const SHARE: usize = 1 << 12;

/// Runs `work` for each number below `count`; each is something to do for itself.
pub fn each(count: usize, work: &(dyn Fn(usize) + Sync)) {
    if count > 1 {
        (0..count).into_par_iter().for_each(work);
    } else if count == 1 {
        work(0);
    }
}

/// Changes every item of a list; `change` gets its number, too.
pub fn update<T: Send>(list: &mut [T], change: impl Fn(usize, &mut T) + Sync) {
    update_shares(list, SHARE, |first, items| {
        for (number, item) in (first..).zip(items) {
            change(number, item);
        }
    });
}

/// Changes a list by shares of `share` items, the last one may be shorter; `change` gets the number of the first item.
pub fn update_shares<T: Send>(
    list: &mut [T],
    share: usize,
    change: impl Fn(usize, &mut [T]) + Sync,
) {
    // Each share is taken once: no thread waits.
    let shares: Vec<_> = list.chunks_mut(share).map(Mutex::new).collect();
    each(shares.len(), &|number| {
        change(number * share, &mut shares[number].lock().unwrap_or_else(PoisonError::into_inner));
    });
}

/// What `of` gives for each number below `count`.
pub fn map<T: Clone + Default + Send>(count: usize, of: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let mut all = vec![T::default(); count];
    update(&mut all, |number, item| *item = of(number));
    all
}

/// The same where each number is a job of its own.
pub fn map_each<T: Clone + Default + Send>(count: usize, of: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let mut all = vec![T::default(); count];
    update_shares(&mut all, 1, |number, item| item[0] = of(number));
    all
}

/// What `of` gives for the numbers below `count`, where it gives something.
pub fn filter_map<T: Clone + Send>(count: usize, of: impl Fn(usize) -> Option<T> + Sync) -> Vec<T> {
    of_shares(count, |numbers| numbers.filter_map(&of).collect::<Vec<T>>()).concat()
}

/// The numbers below `count` for which `holds`.
pub fn filter(count: usize, holds: impl Fn(u32) -> bool + Sync) -> Vec<u32> {
    filter_map(count, |number| Some(number as u32).filter(|&number| holds(number)))
}

/// How many numbers below `count` are such that `holds`.
pub fn count(count: usize, holds: impl Fn(u32) -> bool + Sync) -> usize {
    fold(count, &0, |sum, number| sum + usize::from(holds(number as u32)), |a, b| a + b)
}

/// Adds the numbers below `count` up: those of a share to `nothing` by `add`, the shares by `both`.
pub fn fold<T: Clone + Send + Sync>(
    count: usize,
    nothing: &T,
    add: impl Fn(T, usize) -> T + Sync,
    both: impl Fn(T, T) -> T,
) -> T {
    let shares = of_shares(count, |numbers| Some(numbers.fold(nothing.clone(), &add)));
    shares.into_iter().flatten().fold(nothing.clone(), both)
}

/// What `of` gives for each share of the numbers below `count`.
fn of_shares<T: Clone + Default + Send>(
    count: usize,
    of: impl Fn(Range<usize>) -> T + Sync,
) -> Vec<T> {
    let of_share = |number| of(number * SHARE..count.min((number + 1) * SHARE));
    map_each(count.div_ceil(SHARE), of_share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_gathered_stands_in_the_order_of_the_numbers() {
        for count in [0, 1, SHARE - 1, SHARE, 3 * SHARE + 7] {
            let squares: Vec<usize> = (0..count).map(|k| k * k).collect();
            assert_eq!(map(count, |k| k * k), squares);
            let odd = |k: u32| k % 2 == 1;
            assert_eq!(
                filter(count, odd),
                (0..count as u32).filter(|&k| odd(k)).collect::<Vec<_>>()
            );
            assert_eq!(super::count(count, odd), count / 2);
            assert_eq!(fold(count, &0, |sum, k| sum + k, |a, b| a + b), (0..count).sum::<usize>());
            let mut list = squares;
            update(&mut list, |k, item| *item -= k * k);
            assert!(list.iter().all(|&item| item == 0));
        }
    }
}
