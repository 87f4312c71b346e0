//! The decoder of packed clouds gives up on some damaged files by panicking: a message is made of that. On others it calls
//! itself again and again: it has a stack of its own, which only a file made for that fills.

use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;

/// Stack of the decoder (bytes), of which the system gives what is used. `laz` 0.13.0 (`las/gps.rs`) calls itself for every
/// change of the sequence of times, which no sound file makes twice in a row.
const STACK_BYTES: usize = 1 << 30;

/// Works on a thread with room for many calls.
pub(super) fn with_room<T: Send>(work: impl FnOnce() -> T + Send) -> std::io::Result<T> {
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(STACK_BYTES);
        let done = thread.spawn_scoped(scope, work)?.join();
        Ok(done.unwrap_or_else(|why| panic::resume_unwind(why)))
    })
}

thread_local! {
    /// Whether this thread is inside of the decoder.
    static IS_DECODING: Cell<bool> = const { Cell::new(false) };
}

/// What `decode` gives; none if it panics, about which nothing is printed.
pub(super) fn guarded<T>(decode: impl FnOnce() -> T) -> Option<T> {
    static SILENCED: Once = Once::new();
    SILENCED.call_once(|| {
        let print = panic::take_hook();
        panic::set_hook(Box::new(move |why| {
            if !IS_DECODING.get() {
                print(why);
            }
        }));
    });
    let before = IS_DECODING.replace(true);
    let done = panic::catch_unwind(AssertUnwindSafe(decode));
    IS_DECODING.set(before);
    done.ok()
}
