//! Path data: relative, whole tenths, no doubled points; lines clipped to a frame and thinned.

use crate::math;
use std::fmt::Write as _;

/// A point on paper (px, y downwards).
pub type Spot = (f64, f64);

/// A rectangle on paper (px, y downwards).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperFrame {
    /// Left edge.
    pub left: f64,
    /// Upper edge.
    pub top: f64,
    /// Right edge.
    pub right: f64,
    /// Lower edge.
    pub bottom: f64,
}

impl PaperFrame {
    /// The same with so much more on every side (px), less where it is negative.
    #[must_use]
    pub fn grown(&self, by_px: f64) -> Self {
        Self {
            left: self.left - by_px,
            top: self.top - by_px,
            right: self.right + by_px,
            bottom: self.bottom + by_px,
        }
    }

    /// Width (px).
    pub fn width(&self) -> f64 {
        self.right - self.left
    }

    /// Height (px).
    pub fn height(&self) -> f64 {
        self.bottom - self.top
    }

    /// Whether two frames share room.
    pub fn meets(&self, other: &Self) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }

    /// Whether another frame lies inside.
    pub fn contains(&self, other: &Self) -> bool {
        self.left <= other.left
            && other.right <= self.right
            && self.top <= other.top
            && other.bottom <= self.bottom
    }

    /// Whether a point lies inside or on the edge.
    pub fn holds(&self, (x, y): Spot) -> bool {
        (self.left..=self.right).contains(&x) && (self.top..=self.bottom).contains(&y)
    }
}

/// Tenths of a pixel.
pub fn tenths((x, y): Spot) -> (i32, i32) {
    ((x * super::TENTHS).round() as i32, (y * super::TENTHS).round() as i32)
}

/// Appends `M x y l dx dy …`; nothing when fewer than one point is left.
pub fn append_line(data: &mut String, points: impl IntoIterator<Item = (i32, i32)>) {
    let mut last: Option<(i32, i32)> = None;
    for (x, y) in points {
        match last {
            None => append_pair(data, 'M', x, y),
            Some(before) if before == (x, y) => continue,
            Some((x0, y0)) => append_pair(data, 'l', x - x0, y - y0),
        }
        last = Some((x, y));
    }
}

/// Appends a dot: a line of no length, which a round cap turns into a disc.
pub fn append_dot(data: &mut String, at: Spot) {
    let (x, y) = tenths(at);
    append_pair(data, 'M', x, y);
    data.push_str("h0");
}

/// Appends a closed square. (A square cap on a line of no length is drawn differently by every program.)
pub fn append_square(data: &mut String, (x, y): Spot, half_px: f64) {
    let (left, top) = tenths((x - half_px, y - half_px));
    let side = tenths((2.0 * half_px, 0.0)).0;
    append_pair(data, 'M', left, top);
    let _ = write!(data, "h{side}v{side}h-{side}z");
}

/// Appends a closed rectangle between two corners.
pub fn append_rectangle(data: &mut String, a: Spot, b: Spot) {
    let ((x0, y0), (x1, y1)) = (tenths(a), tenths(b));
    append_pair(data, 'M', x0, y0);
    let _ = write!(data, "h{}v{}h{}z", x1 - x0, y1 - y0, x0 - x1);
}

fn append_pair(data: &mut String, command: char, x: i32, y: i32) {
    // a minus sign separates two numbers as well as a space does
    let gap = if y < 0 { "" } else { " " };
    let _ = write!(data, "{command}{x}{gap}{y}");
}

/// The parts of a line inside a frame; points that are not finite end a part.
pub fn clipped(line: &[Spot], frame: &PaperFrame) -> Vec<Vec<Spot>> {
    let mut parts: Vec<Vec<Spot>> = Vec::new();
    for pair in line.windows(2) {
        let Some((a, b)) = clipped_segment(pair[0], pair[1], frame) else { continue };
        match parts.last_mut() {
            // the same point bit for bit: the line goes on
            Some(part) if part.last() == Some(&a) => part.push(b),
            _ => parts.push(vec![a, b]),
        }
    }
    parts
}

/// The part of a segment inside a frame (Liang & Barsky 1984).
fn clipped_segment(a: Spot, b: Spot, frame: &PaperFrame) -> Option<(Spot, Spot)> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    if !(a.0 + a.1 + dx + dy).is_finite() {
        return None;
    }
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    let edges = [
        (-dx, a.0 - frame.left),
        (dx, frame.right - a.0),
        (-dy, a.1 - frame.top),
        (dy, frame.bottom - a.1),
    ];
    for (toward, room) in edges {
        if toward == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if toward < 0.0 {
            from = from.max(room / toward);
        } else {
            to = to.min(room / toward);
        }
    }
    if from > to {
        return None;
    }
    let at = |t: f64| (a.0 + t * dx, a.1 + t * dy);
    Some((if from > 0.0 { at(from) } else { a }, if to < 1.0 { at(to) } else { b }))
}

/// The points that a line needs to stay within `tolerance` of itself (Douglas & Peucker 1973).
pub fn thinned(line: &[Spot], tolerance: f64) -> Vec<Spot> {
    if line.len() < 3 {
        return line.to_vec();
    }
    let mut is_kept = vec![false; line.len()];
    is_kept[0] = true;
    is_kept[line.len() - 1] = true;
    let mut open = vec![(0, line.len() - 1)];
    while let Some((first, last)) = open.pop() {
        let Some((farthest, distance)) = farthest_from_chord(line, first, last) else { continue };
        if distance > tolerance {
            is_kept[farthest] = true;
            open.push((first, farthest));
            open.push((farthest, last));
        }
    }
    line.iter().zip(is_kept).filter_map(|(&spot, kept)| kept.then_some(spot)).collect()
}

fn farthest_from_chord(line: &[Spot], first: usize, last: usize) -> Option<(usize, f64)> {
    (first + 1..last)
        .map(|i| (i, distance_to_segment(line[i], line[first], line[last])))
        .max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Distance of a point from a segment: from the chord's line alone, a path that turns back would be lost.
pub fn distance_to_segment(p: Spot, a: Spot, b: Spot) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let length2 = dx * dx + dy * dy;
    let t = if length2 > 0.0 { ((p.0 - a.0) * dx + (p.1 - a.1) * dy) / length2 } else { 0.0 };
    let t = t.clamp(0.0, 1.0);
    math::hypot(p.0 - a.0 - t * dx, p.1 - a.1 - t * dy)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: PaperFrame = PaperFrame { left: 0.0, top: 0.0, right: 10.0, bottom: 10.0 };

    #[test]
    fn a_path_is_written_short() {
        let mut data = String::new();
        append_line(&mut data, [(10, 20), (10, 20), (13, 15), (13, 15), (12, 16)]);
        assert_eq!(data, "M10 20l3-5l-1 1");
    }

    /// A line that leaves and comes back is cut where it crosses the frame, not bent onto it.
    #[test]
    fn a_line_outside_the_frame_is_cut_not_bent() {
        let parts = clipped(&[(5.0, 5.0), (15.0, 5.0), (15.0, 8.0), (5.0, 8.0)], &FRAME);
        assert_eq!(parts, vec![vec![(5.0, 5.0), (10.0, 5.0)], vec![(10.0, 8.0), (5.0, 8.0)]]);
        assert!(clipped(&[(-1.0, -1.0), (-1.0, 20.0)], &FRAME).is_empty());
        assert_eq!(clipped(&[(1.0, 1.0), (f64::NAN, 2.0), (3.0, 3.0)], &FRAME).len(), 0);
    }

    /// Every dropped point stays within the tolerance of what is drawn: the promise of the method.
    #[test]
    fn thinning_moves_no_point_by_more_than_the_tolerance() {
        let line: Vec<Spot> = (0..2000)
            .map(|i| f64::from(i) * 0.05)
            .map(|x| (x, 30.0 * (0.3 * x).sin().abs()))
            .collect();
        let thin = thinned(&line, 0.15);
        assert!(thin.len() * 5 < line.len(), "{} of {} points kept", thin.len(), line.len());
        for &p in &line {
            let nearest = thin
                .windows(2)
                .map(|s| distance_to_segment(p, s[0], s[1]))
                .fold(f64::INFINITY, f64::min);
            // 1e-9 px for rounding
            assert!(nearest <= 0.15 + 1e-9, "{p:?} is {nearest} px off");
        }
    }
}
