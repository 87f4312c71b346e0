//! First contact of a ball on a parabola with one triangle and the edges and corners it owns.
//!
//! The distance of the centre from a face's plane is a quadratic in time, the squared distances
//! from an edge's line and from a corner are quartics: every contact is a root of one of them,
//! without any time step. Features that cannot be touched are excluded before a root is computed:
//! by the range of heights, by the sides of the triangle, and by the normal cone of each edge and
//! corner (`Brim`), which gives the heights over the plane at which it can be touched at all.
//!
//! Signs: heights are over the triangle's plane along its normal (m); the ball may land on either
//! side, so both are tested. Each edge and corner belongs to one triangle only, so no quartic is
//! solved twice; flat ones belong to none.

use super::edge_windows::EdgeWindows;
use super::roots::{first_downcrossing, quadratic};
use super::{Parabola, fast_max, fast_min};
use crate::contact::closest::Segment;
use crate::rock::Vec3;
use crate::terrain::Terrain;
use crate::terrain::brims::Brim;
use crate::terrain::faces::Face;
use crate::terrain::seen::Seen;

/// A start nearer to contact than this counts as touching (–, relative to R²): rounding of the
/// contact before.
const TOUCHING: f64 = 1e-12;
/// A range of heights is extended by this (–, relative to R): rounding.
const RANGE_SLACK: f64 = 1e-9;
/// A foot this far beside a triangle still lies on it (–, relative to R): there must be no gap
/// between neighbours.
const FOOT_SLACK: f64 = 1e-9;
/// Added to the sine of the steepest direction of a normal cone (–). Three digits suffice: it only
/// decides how many triangles are tested.
const SINE_MARGIN: f64 = 1e-3;
/// A start beside a triangle but this little below its plane (–, relative to R) is on a neighbour
/// in the same plane.
const PLANE_SLACK: f64 = 1e-9;

/// First contact (s) within a time window with the triangle and the edges and corners that it owns.
#[inline]
pub(super) fn first_contact_s(
    terrain: &Terrain,
    t: u32,
    flight: &Parabola,
    window: (f64, f64),
) -> Option<f64> {
    let (ta, tb) = (fast_max(window.0, 0.0), window.1);
    let face = terrain.face(t);
    // h(t) = h0 + h1 t + h2 t²: gravity acts along −z only, so its part along the normal is −g
    // n_z/2
    let height = Height {
        h0: face.n.dot(&(flight.start - face.a)),
        h1: face.n.dot(&flight.velocity),
        h2: -0.5 * flight.gravity * face.n.z,
    };
    let range = height.range((ta, tb));
    let near = flight.radius * (1.0 + RANGE_SLACK);
    // most triangles near a path end here: the ball stays on one side of the plane, farther than
    // its radius
    if range.0 > near || range.1 < -near {
        return None;
    }
    // every contact found shortens the window for the features after it
    let mut best = tb;
    let mut found = None;
    // The ball may land on either side, whichever it is on now: the plane continues beyond the
    // triangle.
    let slack = FOOT_SLACK * flight.radius;
    let starts_near = ta <= 0.0 && starts_near(&face, flight, height.h0);
    let on_it = starts_near && face.holds_foot_of(&flight.start, slack);
    // a window whose greatest height stays below the radius cannot hold a landing from above
    let level = flight.radius * (1.0 - 2.0 * RANGE_SLACK);
    for (side, above) in [(1.0, range.1), (-1.0, -range.0)] {
        if (above >= level || on_it)
            // the plane is touched at t, the triangle only if the foot of the centre then lies on
            // it
            && let Some(t) = height.landing_s(side, (flight.radius, on_it), range, (ta, best))
            // 1e-9 R beside the triangle still counts: no gap between two neighbours to fall
            // through
            && face.holds_foot_of(&flight.centre(t), slack)
        {
            best = t;
            found = Some(t);
        }
    }
    // edges and corners after the face: if the face is touched first, their windows are shorter
    let brim = &terrain.features.brims[t as usize];
    if brim.front | brim.back | brim.anywhere == 0 {
        return found;
    }
    for boundary in
        boundary_features(brim, flight.radius, starts_near && is_pressed_in(terrain, t, flight))
    {
        if boundary.owned == 0 || boundary.heights.0 > range.1 || boundary.heights.1 < range.0 {
            continue;
        }
        // the touch lies between two heights over this plane (normal cone), which is a part of the
        // window again
        let window = height.within(boundary.heights, (ta, best));
        if window.0 <= window.1
            && let Some(t) = boundary_impact_s(terrain, t, flight, (&boundary, window))
        {
            best = t;
            found = Some(t);
        }
    }
    found
}

/// Whether the ball may be nearer than its radius to a triangle when it starts, at a height of `h0`
/// (m). At this height it reaches `√(R² − h0²)` sideways in the plane.
#[inline]
fn starts_near(face: &Face, flight: &Parabola, h0: f64) -> bool {
    let lateral2 = flight.radius * flight.radius - h0 * h0;
    if lateral2 <= 0.0 {
        return false;
    }
    let lateral_m = lateral2.sqrt() + RANGE_SLACK * flight.radius;
    Seen::of(face, flight.start - face.a, (h0, lateral_m)).is_some()
}

/// Edges and corners of a triangle that are touched from the same side.
struct BoundaryFeatures {
    /// Bits 0–2 edges, bits 3–5 corners.
    owned: u8,
    /// Heights of the centre over the triangle's plane at a contact (m).
    heights: (f64, f64),
    /// Largest distance of the centre beside the triangle (m).
    lateral_m: f64,
}

/// The edges and corners that a triangle owns, as they are touched from in front, from behind and
/// from anywhere; all of them from anywhere if the ball is pressed in.
#[inline]
fn boundary_features(brim: &Brim, radius: f64, is_pressed: bool) -> [BoundaryFeatures; 3] {
    let near = radius * (1.0 + RANGE_SLACK);
    let anywhere = |owned: u8| BoundaryFeatures { owned, heights: (-near, near), lateral_m: near };
    if is_pressed {
        return [anywhere(brim.front | brim.back | brim.anywhere), anywhere(0), anywhere(0)];
    }
    // a contact with the steepest normal has its foot `√(1 − least²)` R beside the triangle
    let lateral_m = |least: f64| ((1.0 - least * least).max(0.0).sqrt() + SINE_MARGIN) * radius;
    let [front, back] =
        [brim.least_front, brim.least_back].map(|least| f64::from(least) - RANGE_SLACK);
    [
        BoundaryFeatures {
            owned: brim.front,
            heights: (front * radius, near),
            lateral_m: lateral_m(front),
        },
        BoundaryFeatures {
            owned: brim.back,
            heights: (-near, -back * radius),
            lateral_m: lateral_m(back),
        },
        anywhere(brim.anywhere),
    ]
}

/// Whether the ball starts pressed into one of the edges and corners that a triangle owns. There it
/// returns to its starting distance, not to the radius, and may do so from where it could not touch
/// otherwise.
///
/// Evaluated only for features near the start; a flight that begins in the air has nothing pressed
/// in.
fn is_pressed_in(terrain: &Terrain, t: u32, flight: &Parabola) -> bool {
    let brim = &terrain.features.brims[t as usize];
    let owned = brim.front | brim.back | brim.anywhere;
    let corners = terrain.corners_m(t);
    let pressed2 = flight.radius * flight.radius * (1.0 - RANGE_SLACK);
    // distance to the corner, then to the side that starts there, both against R²(1 − 1e-9)
    (0..3).any(|k| {
        let to = flight.start - corners[k];
        if owned & (8 << k) != 0 && to.norm_squared() < pressed2 {
            return true;
        }
        let side = corners[(k + 1) % 3] - corners[k];
        let share = (side.dot(&to) / side.norm_squared()).clamp(0.0, 1.0);
        owned & (1 << k) != 0 && (to - side * share).norm_squared() < pressed2
    })
}

/// First contact (s) with some of the edges and corners of a triangle.
#[inline]
fn boundary_impact_s(
    terrain: &Terrain,
    t: u32,
    flight: &Parabola,
    (boundary, window): (&BoundaryFeatures, (f64, f64)),
) -> Option<f64> {
    let face = terrain.face(t);
    let (owned, lateral_m) = (boundary.owned, boundary.lateral_m);
    let duration_s = window.1 - window.0;
    // |v| + g h/2 bounds the mean speed in the window, and so the displacement of the foot
    let path_m =
        (flight.velocity(window.0).norm() + 0.5 * flight.gravity * duration_s) * duration_s;
    Seen::of(
        &face,
        flight.centre(window.0) - face.a,
        (0.0, path_m + lateral_m + RANGE_SLACK * flight.radius),
    )?;
    let edge_windows = EdgeWindows::new(&face, flight, window);
    let (mut best, mut found) = (window.1, None);
    // each touch found shortens the window of the next
    for k in 0..3 {
        let window = (window.0, best);
        let times = [
            (owned & (1 << k) != 0 && edge_windows.edge(k, lateral_m))
                .then(|| edge_impact_s(terrain, t, k, flight, window)),
            (owned & (8 << k) != 0 && edge_windows.corner(k))
                .then(|| corner_impact_s(terrain, t, k, flight, window)),
        ];
        for time in times.into_iter().flatten().flatten() {
            if time <= best {
                (best, found) = (time, Some(time));
            }
        }
    }
    found
}

/// Height of the centre over a plane, a quadratic in time.
struct Height {
    /// Height at time 0 (m).
    h0: f64,
    /// Its rate at time 0 (m/s).
    h1: f64,
    /// Half its second derivative (m/s²), `−g n_z/2`.
    h2: f64,
}

impl Height {
    /// Rate of the height (m/s) at a time (s).
    fn speed(&self, t: f64) -> f64 {
        self.h1 + 2.0 * self.h2 * t
    }

    /// Height (m) at a time (s).
    #[inline]
    fn at(&self, t: f64) -> f64 {
        self.h0 + t * (self.h1 + t * self.h2)
    }

    /// Lowest and highest value in a window: at its ends and, if the turning point `t = −h1/(2 h2)`
    /// is inside, there.
    #[inline]
    fn range(&self, (ta, tb): (f64, f64)) -> (f64, f64) {
        let (ha, hb) = (self.at(ta), self.at(tb));
        // without a second derivative the turning point is infinite or NaN and lies in no window
        let turn = -0.5 * self.h1 / self.h2;
        let ht = if turn > ta && turn < tb { self.at(turn) } else { ha };
        (fast_min(fast_min(ha, hb), ht), fast_max(fast_max(ha, hb), ht))
    }

    /// The part of a window in which the height may be between two levels; reversed if nowhere.
    ///
    /// The height is a parabola and can enter and leave the band twice; the hull of all parts is
    /// returned.
    #[inline]
    fn within(&self, (low, high): (f64, f64), (ta, tb): (f64, f64)) -> (f64, f64) {
        let holds = |t: f64| (low..=high).contains(&self.at(t));
        let (mut first, mut last) =
            (if holds(ta) { ta } else { tb }, if holds(tb) { tb } else { ta });
        if first > ta || last < tb {
            for level in [high, low] {
                let (first_s, second_s) =
                    quadratic(self.h2, self.h1, self.h0 - level).unwrap_or((tb, ta));
                for t in [first_s, second_s].into_iter().filter(|&t| t > ta && t < tb) {
                    (first, last) = (fast_min(first, t), fast_max(last, t));
                }
            }
        }
        (first, last)
    }

    /// First time in the window at which the ball comes down to the plane from one side (+1, −1).
    ///
    /// A ball that starts on the triangle (`on_it`), or at most a rounding below its plane, lands
    /// when it is back at its starting height: it can never fall through. One that starts beside
    /// the triangle may be anywhere relative to the plane and must come down to the full radius.
    #[inline]
    fn landing_s(
        &self,
        side: f64,
        (radius, on_it): (f64, bool),
        (low, high): (f64, f64),
        (ta, tb): (f64, f64),
    ) -> Option<f64> {
        let (h0, h1, h2) = (side * self.h0, side * self.h1, side * self.h2);
        let touching = h0 >= 0.0
            && h0 < radius * (1.0 + TOUCHING)
            && (on_it || h0 > radius * (1.0 - PLANE_SLACK));
        // exactly on the plane and moving into it, or drawn into it by gravity at once: a contact
        // now, however small the speed
        if touching && ta <= 0.0 && (h1 < 0.0 || h1 == 0.0 && h2 < 0.0) {
            return Some(0.0);
        }
        // Pressed in at the start, a contact at the radius would come at once, or never if the ball
        // leaves slowly. So the contact is at the starting depth, and a grazing start can never
        // fall through.
        let level = if touching { fast_min(h0, radius) } else { radius };
        let (below, above) = if side > 0.0 { (low, high) } else { (-high, -low) };
        if level < below - RANGE_SLACK * radius || level > above + RANGE_SLACK * radius {
            return None;
        }
        let (first_s, second_s) = quadratic(h2, h1, h0 - level)?;
        // The first of the two roots at which the height falls; upwards through the level is a
        // separation. A start on the level has a root at 0 that is no fall.
        [first_s, second_s]
            .into_iter()
            .find(|&t| t >= ta && t <= tb && side * self.speed(t) < 0.0 && (t > 0.0 || h1 < 0.0))
    }
}

/// When the ball touches edge `k` of a triangle: the distance to its line falls to the radius while
/// the foot lies between the ends.
///
/// `|(1 − e eᵀ)(c(t) − a)|² = R²`: a quartic in `t`, because gravity has a part across the edge.
fn edge_impact_s(
    terrain: &Terrain,
    t: u32,
    k: usize,
    flight: &Parabola,
    window: (f64, f64),
) -> Option<f64> {
    let corners = terrain.triangles[t as usize];
    let ends_m = [corners[k], corners[(k + 1) % 3]].map(|v| terrain.vertices_m[v as usize]);
    let Segment { a, along, length } = Segment::between(ends_m);
    // the part normal to the edge: across the edge the problem is a point and a moving centre in a
    // plane
    let off = |x: Vec3| x - along * along.dot(&x);
    let fall = Vec3::new(0.0, 0.0, -0.5 * flight.gravity);
    let slack = 1e-11 * length;
    // beyond an end the corner is nearer and is tested by itself
    let is_abreast = |x: Vec3| (-slack..=length + slack).contains(&along.dot(&(x - a)));
    let path = [off(flight.start - a), off(flight.velocity), off(fall)];
    // the line continues beyond the edge: the ball may touch it there first and the edge later
    sphere_contact_s(path, flight.radius, window, &|t| is_abreast(flight.centre(t)))
}

/// When the ball touches corner `k` of a triangle: `|c(t) − p|² = R²`.
fn corner_impact_s(
    terrain: &Terrain,
    t: u32,
    k: usize,
    flight: &Parabola,
    window: (f64, f64),
) -> Option<f64> {
    let p = terrain.vertices_m[terrain.triangles[t as usize][k] as usize];
    let fall = Vec3::new(0.0, 0.0, -0.5 * flight.gravity);
    sphere_contact_s([flight.start - p, flight.velocity, fall], flight.radius, window, &|_| true)
}

/// First time accepted by `accepts` at which `|x0 + x1 t + x2 t²|` falls to the radius.
#[inline]
fn sphere_contact_s(
    [x0, x1, x2]: [Vec3; 3],
    radius: f64,
    (ta, tb): (f64, f64),
    accepts: &impl Fn(f64) -> bool,
) -> Option<f64> {
    let r2 = radius * radius;
    // |x0 + x1 t + x2 t²|² − R² in powers of t
    let gap = x0.norm_squared() - r2;
    let slope = 2.0 * x0.dot(&x1);
    let curve = x1.norm_squared() + 2.0 * x0.dot(&x2);
    let cubic = 2.0 * x1.dot(&x2);
    // touching at the start: a decreasing distance is a contact at 0, to first or second order
    if ta <= 0.0 && gap < TOUCHING * r2 && accepts(0.0) {
        if slope < 0.0 || slope == 0.0 && curve < 0.0 {
            return Some(0.0);
        }
        // Starting inside or at the radius and moving away: it touches again when it is back at its
        // starting distance. The root at 0 is divided out, which leaves a cubic.
        return first_downcrossing(
            &[slope, curve, cubic, x2.norm_squared(), 0.0],
            (0.0, tb),
            accepts,
        );
    }
    first_downcrossing(&[gap, slope, curve, cubic, x2.norm_squared()], (ta, tb), accepts)
}
