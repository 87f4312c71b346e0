//! How a run ends before its last rock: by an error, by the user, by a bug.

use crate::made;

use made::fall;
use rockfall::ensemble::Ensemble;
use rockfall::error::Error;
use std::sync::atomic::Ordering;

/// The error of the smallest release number, whichever thread met its own first; no chunk follows.
#[test]
fn an_error_ends_the_run() {
    let ensemble = Ensemble::new(Some(2)).unwrap();
    let refuse = |index: usize, (): &mut ()| match index {
        11 | 12 => Err(Error::Request(format!("release {index} lies beside the terrain"))),
        _ => Ok(fall(index)),
    };
    let mut chunks = ensemble.in_chunks(0..1000, || (), refuse);
    assert_eq!(
        chunks.next().unwrap().unwrap_err().to_string(),
        "release 11 lies beside the terrain"
    );
    assert!(chunks.next().is_none());
    assert!(Ensemble::new(Some(0)).is_err());
}

#[test]
fn a_stop_ends_the_run_behind_the_chunk_in_hand() {
    let ensemble = Ensemble::new(Some(2)).unwrap();
    let stop = ensemble.stop_flag();
    let mut chunks = ensemble.in_chunks(
        0..1000,
        || (),
        |index, ()| {
            stop.store(true, Ordering::Relaxed);
            Ok(fall(index))
        },
    );
    assert!(!chunks.next().unwrap().unwrap().is_empty());
    assert!(chunks.next().is_none());
}

#[test]
#[should_panic(expected = "a bug")]
fn a_panic_is_not_hidden() {
    let ensemble = Ensemble::new(Some(2)).unwrap();
    let broken = |index: usize, (): &mut ()| {
        assert!(index != 5, "a bug");
        Ok(fall(index))
    };
    ensemble.in_chunks(0..10, || (), broken).for_each(drop);
}
