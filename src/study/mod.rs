//! What the numerics cost and what they are worth: error against run time, stability, exact cases.
//!
//! ```text
//! cases ─┬─► exact      error of every scheme against the exact solution, over run time
//!        └─► stability  stiff and extreme cases, each held against its bound
//! plan ────► scene      sampling and discretisation error of a scene's own statistics
//! ```

pub mod bench;
pub mod cases;
pub mod exact;
pub mod exact_figure;
