//! Shear force and rolling moment of one contact, solved in the contact's own frame.
//!
//! Both are springs with dashpots in series with sliders. They act on each other: shear turns the rock, the moment
//! changes the slip. Three of the four cases (stick or slip, each) are solved in closed form.

use super::law::Body;
use crate::ground::Law;
use crate::rock::Vec3;

/// A vector along a surface, in the frame of a contact.
pub(crate) type Along = [f64; 2];
/// A vector in the frame of a contact: two tangents, then the normal.
pub(crate) type Local = [f64; 3];

/// Right-handed unit vectors of a contact: two tangents and the normal from the mesh to the centre.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Frame {
    s: Vec3,
    t: Vec3,
    n: Vec3,
}

impl Frame {
    /// The frame of a normal, without a branch and without a root (Duff et al. 2017).
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

/// What a contact answers with over a stage of a given length: the same for all stages of a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Answers {
    /// Shear force per slip speed (N s/m) and moment per spin (N m s) while they stick.
    pub(crate) kap: f64,
    pub(crate) kar: f64,
    /// `1/(1 + B)`.
    share_q: f64,
    /// `C`.
    c: f64,
    /// `1/(1 + E)`.
    share_m: f64,
    /// `E R`.
    er: f64,
    /// `1/(1 − C E R/((1 + B)(1 + E)))`.
    both: f64,
}

impl Answers {
    #[inline]
    pub(crate) fn of(body: &Body, law: &Law, h: f64) -> Self {
        let (kap, kar) = (law.p_s * h + law.c_s, law.k_r * h + law.c_r);
        let (turn_q, turn_m) = (kap * h / body.inertia, kar * h / body.inertia);
        // The contact point's mass along the surface is 2/7 m.
        Self::new((kap, kar), 3.5 * kap * h / body.mass, turn_m, (turn_q, body.radius))
    }

    /// The limit of stiff springs, for impulses: `q̂ = 2/7 m slip − 5/7 n × M/R` and `M̂ = I w + R n × q`.
    #[inline]
    pub(crate) fn rigid(radius: f64) -> Self {
        let (c, er) = (5.0 / 7.0 / radius, radius);
        Self { kap: 0.0, kar: 0.0, share_q: 1.0, c, share_m: 1.0, er, both: 3.5 }
    }

    #[inline]
    fn new((kap, kar): (f64, f64), b: f64, e: f64, (turn_q, r): (f64, f64)) -> Self {
        let (share_q, share_m, c, er) = (1.0 / (1.0 + b), 1.0 / (1.0 + e), turn_q * r, e * r);
        let both = 1.0 / (1.0 - c * er * share_q * share_m);
        Self { kap, kar, share_q, c, share_m, er, both }
    }
}

/// The coupled shear force `q` and rolling moment `M` of one contact over one stage: each is the shortening to its cap of
/// `q̂ = (a − C n × M)/(1 + B)` and `M̂ = (d + E R n × q)/(1 + E)`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pair<'a> {
    pub(crate) answers: &'a Answers,
    /// What the shear spring would hold without being moved by `q` and `M` (N).
    pub(crate) a: Along,
    /// The same of the rolling spring (N m).
    pub(crate) d: Local,
    /// Largest shear force (N) and rolling moment (N m).
    pub(crate) caps: (f64, f64),
}

/// Newton steps for the ratio of a rolling moment at its cap.
const RATIO_STEPS: u32 = 30;
/// Most double passes of shear and rolling in one contact.
const ALTERNATIONS: u32 = 30;
/// Change of a force, relative to its scale, below which it has settled (–).
const SETTLED: f64 = 1e-10;

/// `n × x`, along the surface.
#[inline]
fn turned(x: Along) -> Along {
    [-x[1], x[0]]
}

#[inline]
fn size2(x: Along) -> f64 {
    x[0] * x[0] + x[1] * x[1]
}

#[inline]
fn volume2(x: Local) -> f64 {
    x[0] * x[0] + x[1] * x[1] + x[2] * x[2]
}

/// Shortens a vector along the surface to at most `cap`.
#[inline]
pub(crate) fn cut(x: Along, cap: f64) -> Along {
    let size2 = size2(x);
    if size2 > cap * cap {
        let share = cap / size2.sqrt();
        [x[0] * share, x[1] * share]
    } else {
        x
    }
}

/// Shortens a moment to at most `cap`.
#[inline]
pub(crate) fn cut_moment(x: Local, cap: f64) -> Local {
    let size2 = volume2(x);
    if size2 > cap * cap { x.map(|x| x * (cap / size2.sqrt())) } else { x }
}

impl Pair<'_> {
    #[inline]
    pub(crate) fn solve(&self) -> (Along, Local) {
        let (cap_q, cap_m) = self.caps;
        let (q, moment) = self.both_stick();
        let m_fits = volume2(moment) <= cap_m * cap_m;
        if m_fits && size2(q) <= cap_q * cap_q {
            return (q, moment);
        }
        if !m_fits {
            let moment = self.rolling_alone();
            let q = self.shear_at(moment);
            if size2(q) <= cap_q * cap_q {
                return (q, moment);
            }
        }
        let q = self.sliding_alone();
        let moment = self.moment_at(q);
        if volume2(moment) <= cap_m * cap_m {
            return (q, moment);
        }
        self.both_slip(q)
    }

    /// `q̂` for a moment.
    #[inline]
    fn shear_at(&self, moment: Local) -> Along {
        let y = turned([moment[0], moment[1]]);
        [0, 1].map(|k| (self.a[k] - y[k] * self.answers.c) * self.answers.share_q)
    }

    /// `M̂` for a shear force.
    #[inline]
    fn moment_at(&self, q: Along) -> Local {
        let y = turned(q);
        let along = [0, 1].map(|k| (self.d[k] + y[k] * self.answers.er) * self.answers.share_m);
        [along[0], along[1], self.d[2] * self.answers.share_m]
    }

    /// Neither at its cap: with `y = n × M`, `(1+B) q + C y = a` and `E R q + (1+E) y = n × d`.
    #[inline]
    fn both_stick(&self) -> (Along, Local) {
        let &Answers { share_q, c, share_m, er, both, .. } = self.answers;
        let nd = turned([self.d[0], self.d[1]]);
        let q = [0, 1].map(|k| (self.a[k] - nd[k] * (c * share_m)) * (share_q * both));
        let y = [0, 1].map(|k| (nd[k] - self.a[k] * (er * share_q)) * (share_m * both));
        (q, [y[1], -y[0], self.d[2] * share_m])
    }

    /// The moment at its cap while shear sticks: `M_t = λ G_t/(1 − λs)`, `M_n = λ G_n`, a scalar equation for `λ`.
    #[inline]
    fn rolling_alone(&self) -> Local {
        let y = turned(self.a);
        let g = [0, 1].map(|k| self.d[k] + y[k] * (self.answers.er * self.answers.share_q));
        let (t2, n2, cap) = (size2(g), self.d[2] * self.d[2], self.caps.1);
        let s = self.answers.er * self.answers.c * self.answers.share_q;
        // |M| grows with λ. Without a normal part the first guess is exact; with one it is below the root, from where
        // Newton on λ − cap/|G/(1 − λs)| comes up.
        let mut ratio = cap / ((t2.sqrt() + cap * s).powi(2) + n2).sqrt();
        if n2 > SETTLED * SETTLED * t2 {
            for _ in 0..RATIO_STEPS {
                let room = 1.0 / (1.0 - ratio * s);
                let size2 = t2 * room * room + n2;
                let reached = cap / size2.sqrt();
                let slope = 1.0 + reached * t2 * room * room * room * s / size2;
                let change = (ratio - reached) / slope;
                ratio -= change;
                if change.abs() <= SETTLED * ratio {
                    break;
                }
            }
        }
        let along = ratio / (1.0 - ratio * s);
        [g[0] * along, g[1] * along, self.d[2] * ratio]
    }

    /// Shear at its cap while rolling sticks: `q ∥ a − C/(1+E) n × d`.
    #[inline]
    fn sliding_alone(&self) -> Along {
        let y = turned([self.d[0], self.d[1]]);
        let along = [0, 1].map(|k| self.a[k] - y[k] * (self.answers.c * self.answers.share_m));
        let size = size2(along).sqrt();
        if size > 0.0 { along.map(|x| x * (self.caps.0 / size)) } else { along }
    }

    /// Both at their caps: only directions are sought. Alternating them gains a factor of up to 5/7 a pass; what two
    /// passes gain tells where they are heading (Steffensen).
    fn both_slip(&self, mut q: Along) -> (Along, Local) {
        let (cap_q, cap_m) = self.caps;
        let next = |q: Along| cut(self.shear_at(cut_moment(self.moment_at(q), cap_m)), cap_q);
        for _ in 0..ALTERNATIONS {
            let one = next(q);
            let first = [one[0] - q[0], one[1] - q[1]];
            if size2(first) <= (SETTLED * cap_q).powi(2) {
                q = one;
                break;
            }
            let two = next(one);
            let second = [two[0] - one[0], two[1] - one[1]];
            let gain = (first[0] * second[0] + first[1] * second[1]) / size2(first);
            let ahead = if gain.abs() < 0.9 { gain / (1.0 - gain) } else { 0.0 };
            q = cut([two[0] + second[0] * ahead, two[1] + second[1] * ahead], cap_q);
        }
        (q, cut_moment(self.moment_at(q), cap_m))
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
                let frame = Frame::of(&n);
                prop_assert!((frame.s.cross(&frame.t) - n).norm() < 1e-14);
                prop_assert!((frame.out_local(frame.local(&x)) - x).norm() < 1e-14);
            }
        }

        /// Whatever case the closed forms choose, the result is the fixed point of both shortenings; 1e-8 of the caps
        /// is what the alternation of two slipping directions leaves.
        #[test]
        fn shear_and_rolling_solve_their_equations(
            a in prop::array::uniform2(-1.0f64..1.0), d in prop::array::uniform3(-1.0f64..1.0),
            caps in prop::array::uniform2(0.01f64..2.0), spins in prop::bool::ANY,
            b in 0.001f64..100.0, e in 0.001f64..100.0, r in 0.01f64..10.0,
        ) {
            // C E R = 5/7 B E, as a solid sphere has it
            let c = 5.0 / 7.0 * b / r;
            let d = [d[0] * r, d[1] * r, if spins { d[2] * r } else { 0.0 }];
            let answers = Answers::new((b, e), b, e, (c / r, r));
            let pair = Pair { answers: &answers, a, d, caps: (caps[0], caps[1] * r) };
            let (q, moment) = pair.solve();
            let at_m = cut(pair.shear_at(moment), pair.caps.0);
            let at_q = cut_moment(pair.moment_at(q), pair.caps.1);
            let off_q = size2([q[0] - at_m[0], q[1] - at_m[1]]).sqrt();
            let off_m = volume2([0, 1, 2].map(|k| moment[k] - at_q[k])).sqrt();
            prop_assert!(off_q <= 1e-8 * pair.caps.0 && off_m <= 1e-8 * pair.caps.1, "{off_q} {off_m}");
            let (size_q, size_m) = (size2(q).sqrt(), volume2(moment).sqrt());
            prop_assert!(size_q <= pair.caps.0 * (1.0 + 1e-12) && size_m <= pair.caps.1 * (1.0 + 1e-12));
        }
    }
}
