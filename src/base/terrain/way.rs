//! The square cells under a straight way in plan view, edge by edge (Amanatides and Woo 1987).

/// Calls `pass` with column and row of every cell under the way between two places, in units of cells, and the shares of
/// the way at which the cell is entered and left.
///
/// Steps from edge to edge, never cell by cell with a test: it visits exactly the cells under the
/// way, and the parts add up to 1.
#[inline]
pub fn cells_under([from, to]: [[f64; 2]; 2], mut pass: impl FnMut([i64; 2], f64, f64)) {
    let (mut at, last) = (from.map(below), to.map(below));
    let way = [to[0] - from[0], to[1] - from[1]];
    let step = way.map(|x| if x > 0.0 { 1 } else { -1 });
    // share of the way at which the next line of the grid is met along one axis
    let edge = |axis: usize, at: i64| {
        let edge = if way[axis] > 0.0 { at + 1 } else { at };
        if way[axis] == 0.0 { f64::INFINITY } else { (edge as f64 - from[axis]) / way[axis] }
    };
    // so many edges lie between first and last cell: counting them ends the walk, not a comparison
    // of rounded numbers
    let mut left = (last[0] - at[0]).unsigned_abs() + (last[1] - at[1]).unsigned_abs();
    if left == 0 {
        return pass(at, 0.0, 1.0);
    }
    let mut entered = 0.0;
    let mut next = [edge(0, at[0]), edge(1, at[1])];
    loop {
        // an axis that has arrived is not stepped along any more, whatever rounding says
        let axis = usize::from(at[0] == last[0] || at[1] != last[1] && next[1] < next[0]);
        let leaves = if left == 0 { 1.0 } else { next[axis].clamp(entered, 1.0) };
        pass(at, entered, leaves);
        if left == 0 {
            return;
        }
        at[axis] += step[axis];
        next[axis] = edge(axis, at[axis]);
        entered = leaves;
        left -= 1;
    }
}

/// The largest whole number not above `x`: `f64::floor` is a call into the system's library.
#[inline]
fn below(x: f64) -> i64 {
    let whole = x as i64;
    whole - i64::from(whole as f64 > x)
}
