//! Sides and triangles in plan view.

pub use crate::gis::Corner;

/// Whether two sides have a point in common.
pub(super) fn meet([a, b]: [Corner; 2], [c, d]: [Corner; 2]) -> bool {
    let boxes_meet = (0..2).all(|axis| {
        a[axis].min(b[axis]) <= c[axis].max(d[axis]) && c[axis].min(d[axis]) <= a[axis].max(b[axis])
    });
    let apart = |p, q, one, other| twice_area([p, q, one]) * twice_area([p, q, other]) > 0.0;
    boxes_meet && !apart(a, b, c, d) && !apart(c, d, a, b)
}

/// Twice the area of a triangle (m²), positive when it turns anticlockwise.
///
/// Differences first: map coordinates are large and their products would lose the digits that matter.
pub(super) fn twice_area([a, b, c]: [Corner; 3]) -> f64 {
    let (u, v) = (minus(b, a), minus(c, a));
    u[0] * v[1] - u[1] * v[0]
}

pub(super) fn minus(a: Corner, b: Corner) -> Corner {
    [a[0] - b[0], a[1] - b[1]]
}
