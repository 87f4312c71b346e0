//! The decoder of packed clouds gives up on some damaged files by panicking: a message is made of that.

use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;

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
