//! From where the edges and corners of a triangle can be touched: in front of it, behind it, and how steeply.
//!
//! A ball touches an edge or a corner along a direction from its normal cone: away from every face, or along every edge
//! at it. On a mesh that is nearly smooth the cone is a sliver about the normal of the triangle that owns the feature, on
//! the side on which the feature stands out. So a touch at the radius `R` has its centre between `least · R` and `R` over
//! the triangle's plane, which tells most edges and corners apart by a height that is known anyway.

use crate::rock::Vec3;

/// A corner whose nearest edge leans towards the ball by this much can never touch it (–, cosine): far above the slack
/// of the contact's own test, which is 1e-9.
pub(super) const LEANS: f64 = 1e-6;

/// Cosines below which a direction says nothing of its side (–): far above every slack of the touching tests.
const SIDELONG: f64 = 1e-2;
/// Sine of the angle between faces or edges below which the side on which they stand out is not trusted (–).
const BLUNT: f64 = 1e-6;
/// Taken off every bound (–): the slack of the touching tests is 1e-9, that of fitting directions 1e-6.
const SLACK: f64 = 1e-5;
/// Sine of the angle between two edges below which what stands at a right angle to both is not known well (–).
const NEEDLE: f64 = 1e-2;

/// The edges and corners that a triangle owns: bits 0–2 its edges, bits 3–5 its corners. Each is in one of three lists.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Brim {
    /// Touched only by balls whose centre is in front of the triangle's plane …
    pub front: u8,
    /// … only from behind it …
    pub back: u8,
    /// … or from anywhere.
    pub anywhere: u8,
    /// Least height of the centre over the plane when one of `front` is touched (–, relative to its distance).
    pub least_front: f32,
    /// Least depth behind the plane when one of `back` is touched (–, relative to its distance).
    pub least_back: f32,
    /// Corners (bits 0–2) that it is asked for where a ball presses into them: each that is not flat belongs to one triangle.
    pub vertices: u8,
}

/// From where a feature can be touched, seen from its owner's plane: at least so high (–, relative to the distance).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Cone {
    Front(f64),
    Back(f64),
    Anywhere,
}

impl Cone {
    /// Of the edge between two faces, given the normal of one and the unit vectors out of both.
    pub(super) fn of_edge(n: &Vec3, out: &Vec3, other: &Vec3) -> Self {
        // The cone runs from the one normal to the other, through the angle that the faces turn by.
        let (rises, turned) = (n.dot(other), -out.dot(other) - SLACK);
        match rises {
            _ if rises.abs() < BLUNT || turned < SIDELONG => Self::Anywhere,
            _ if rises > 0.0 => Self::Front(turned),
            _ => Self::Back(turned),
        }
    }

    /// Of the corner with edges `along` (unit vectors away from it): its extreme directions stand at a right angle to
    /// two of them.
    pub(super) fn of_corner(n: &Vec3, along: &[Vec3]) -> Self {
        let (mut least, mut most) = (1.0f64, -1.0f64);
        for (number, one) in along.iter().enumerate() {
            for other in &along[number + 1..] {
                let across = one.cross(other);
                let size = across.norm();
                if size < NEEDLE {
                    return Self::Anywhere;
                }
                for side in [1.0, -1.0] {
                    if along.iter().all(|edge| side * edge.dot(&across) <= LEANS * size) {
                        let height = side * n.dot(&across) / size;
                        (least, most) = (least.min(height), most.max(height));
                    }
                }
            }
        }
        // Directions that all lie on one side span a cone whose lowest is one of them.
        match (least - SLACK, -most - SLACK) {
            _ if least > most => Self::Anywhere,
            (front, _) if front > SIDELONG => Self::Front(front),
            (_, back) if back > SIDELONG => Self::Back(back),
            _ => Self::Anywhere,
        }
    }
}

impl Brim {
    /// Owns nothing.
    pub(super) const NONE: Self = Self {
        front: 0,
        back: 0,
        anywhere: 0,
        least_front: f32::INFINITY,
        least_back: f32::INFINITY,
        vertices: 0,
    };

    /// Adds a feature.
    pub(super) fn add(&mut self, bit: u8, cone: Cone) {
        let rounded = |least: f64| (least as f32).next_down();
        match cone {
            Cone::Front(least) => {
                self.front |= bit;
                self.least_front = self.least_front.min(rounded(least));
            }
            Cone::Back(least) => {
                self.back |= bit;
                self.least_back = self.least_back.min(rounded(least));
            }
            Cone::Anywhere => self.anywhere |= bit,
        }
    }
}
