//! The local frame of a contact: a vector along the surface has two components, a rolling moment
//! three.

use crate::rock::Vec3;

/// A vector along a surface, in the frame of a contact.
pub(crate) type Along = [f64; 2];
/// A vector in the frame of a contact: two tangents, then the normal.
pub(crate) type Local = [f64; 3];

/// `x·y`.
#[inline]
pub(crate) fn dot<const N: usize>(x: [f64; N], y: [f64; N]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// `|x|²`.
#[inline]
pub(crate) fn square<const N: usize>(x: [f64; N]) -> f64 {
    dot(x, x)
}

/// Right-handed unit vectors of a contact: two tangents and the normal from the mesh to the centre.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ContactFrame {
    s: Vec3,
    t: Vec3,
    pub(crate) n: Vec3,
}

impl ContactFrame {
    /// The frame of a level surface.
    pub(crate) const LEVEL: Self = Self {
        s: Vec3::new(1.0, 0.0, 0.0),
        t: Vec3::new(0.0, 1.0, 0.0),
        n: Vec3::new(0.0, 0.0, 1.0),
    };

    /// The frame of a normal, without branches and square roots (Duff et al. 2017).
    #[inline]
    pub(crate) fn of(n: &Vec3) -> Self {
        let sign = 1.0f64.copysign(n.z);
        let a = -1.0 / (sign + n.z);
        let b = n.x * n.y * a;
        let s = Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x);
        let t = Vec3::new(b, sign + n.y * n.y * a, -n.y);
        Self { s, t, n: *n }
    }

    #[inline]
    pub(crate) fn along(&self, x: &Vec3) -> Along {
        [self.s.dot(x), self.t.dot(x)]
    }

    #[inline]
    pub(crate) fn local(&self, x: &Vec3) -> Local {
        [self.s.dot(x), self.t.dot(x), self.n.dot(x)]
    }

    #[inline]
    pub(crate) fn out_along(&self, x: Along) -> Vec3 {
        self.s * x[0] + self.t * x[1]
    }

    #[inline]
    pub(crate) fn out_local(&self, x: Local) -> Vec3 {
        self.s * x[0] + self.t * x[1] + self.n * x[2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(-1.0f64..1.0).prop_map(Vec3::from)
    }

    proptest! {
        /// A frame is orthonormal and right-handed for every normal, the straight-down one included.
        #[test]
        fn frames_are_right_handed(n in vector(), x in vector()) {
            prop_assume!(n.norm() > 1e-3);
            for n in [n.normalize(), Vec3::z(), -Vec3::z()] {
                let frame = ContactFrame::of(&n);
                prop_assert!((frame.s.cross(&frame.t) - n).norm() < 1e-14);
                prop_assert!((frame.out_local(frame.local(&x)) - x).norm() < 1e-14);
            }
        }
    }
}
