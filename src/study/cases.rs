//! The exact cases: one row each, with the scene, the exact solution and where it comes from.

mod allowed;
mod blocks;
mod closed;
pub(super) mod meshes;
mod pivot;
mod starts;
mod thrown;

use super::bench::{SETUP, Setup, settings, terrain};
use super::finer::finer;
use crate::rock::Vec3;
use crate::simulation::{Scratch, Trajectory};
use crate::solver::{Scheme, Settings};
use crate::terrain::Terrain;
use crate::terrain::make;
use crate::terrain::stl::Facet;
use meshes::{angle, bumpy, fold, plane, roof, tilted};
use pivot::Lift;
pub(super) use starts::rolling_off_an_edge;
use starts::{
    TIPPED_RAD, along, elastic, in_groove, lying, place, rigid_bounce_m, slippery, tipped, tipping,
};

/// One number of a case: what it should be and how large an error is large.
#[derive(Debug, Clone, Copy)]
pub struct CaseMeasure {
    /// What it is, with its unit.
    pub what: &'static str,
    /// The exact value.
    pub exact: f64,
    /// What an error is compared with, same unit.
    pub scale: f64,
    /// Reads it from a journey.
    pub of: fn(&Trajectory) -> f64,
}

/// What decides how near a scheme comes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CaseKind {
    /// Contact all the time: after the first steps nothing has to be resolved.
    Smooth,
    /// Contact that ends by itself.
    Edge,
    /// Impacts: their dozen steps decide.
    Impact,
    /// Impacts on edges, one after the other: the motion is chaotic.
    Stairs,
    /// Plastic slaps of a face, one after the other, in the rigid limit.
    Slaps,
}

/// One exact case. Schemes with springs are held against the solution with springs, the rigid scheme against its limit.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// Short name, a word.
    pub name: &'static str,
    /// What happens, in a sentence.
    pub title: &'static str,
    /// Where the exact solution comes from.
    pub source: &'static str,
    /// What decides the error.
    pub kind: CaseKind,
    /// Impacts slower than this do not rebound (m/s).
    pub capture_speed_m_s: f64,
    /// The mesh.
    pub facets: fn() -> Vec<Facet>,
    /// Rock, ground and start; with springs or in the rigid limit.
    pub setup: fn(has_springs: bool) -> Setup,
    /// The exact values; none where there is no closed form, only a finer computation.
    pub exact: Option<fn(&Setup, has_springs: bool) -> Vec<CaseMeasure>>,
}

impl Case {
    /// Its mesh, welded.
    pub fn terrain(&self) -> Terrain {
        terrain((self.facets)())
    }

    /// Follows its rock with one scheme at one tolerance (m/s) or step (s).
    pub fn follow(&self, terrain: &Terrain, step: &Settings, scratch: &mut Scratch) -> Trajectory {
        (self.setup)(step.scheme.has_springs()).follow(terrain, step, scratch)
    }

    /// Whether a scheme is held to it: plastic slaps of a face take no time in the rigid limit only.
    pub fn is_for(&self, scheme: Scheme) -> bool {
        self.kind != CaseKind::Slaps || !scheme.has_springs()
    }

    /// Settings of a scheme for this case.
    pub fn settings(&self, scheme: Scheme, fineness: f64) -> Settings {
        let own = settings(scheme, fineness, Some(self.capture_speed_m_s));
        if (self.setup)(scheme.has_springs()).block.is_none() {
            return own;
        }
        // the steps of a block are bound by the way of its corners as well: finer with the setting, and never coarser than usual
        let relative = fineness / scheme.of(USUAL_FINENESS);
        let corner_way = finer(&own, relative, true).corner_way.min(own.corner_way);
        Settings { corner_way, ..own }
    }

    /// What should come out for a scheme. Without a closed form: what the scheme itself gives when it is `finest`.
    pub fn measures(&self, terrain: &Terrain, scheme: Scheme) -> Vec<CaseMeasure> {
        let has_springs = scheme.has_springs();
        if let Some(exact) = self.exact {
            return exact(&(self.setup)(has_springs), has_springs);
        }
        let fineness = if has_springs { FINEST_TOLERANCE_M_S } else { FINEST_STEP_S };
        let finest = self.settings(scheme.finest(), fineness);
        let end = self.follow(terrain, &finest, &mut Scratch::default()).end.position_m;
        place(end.x, end.y, end.z)
    }

    /// Error of a journey: the largest of all measures, relative to their scales (–).
    pub fn error(&self, measures: &[CaseMeasure], journey: &Trajectory) -> f64 {
        let off = |one: &CaseMeasure| ((one.of)(journey) - one.exact).abs() / one.scale;
        // NaN is the largest error of all, and `max` would hide it
        let worst = measures.iter().map(off).fold(0.0, f64::max);
        if measures.iter().any(|one| (one.of)(journey).is_nan()) { f64::INFINITY } else { worst }
    }
}

/// Step (s) or tolerance (m/s) of each scheme at which the corners of blocks go as far as usual.
const USUAL_FINENESS: [f64; 4] = [1e-5, 0.05, 1e-8, 0.01];
/// Tolerance (m/s) of what stands in for an exact solution.
const FINEST_TOLERANCE_M_S: f64 = 1e-10;
/// Step (s) of what stands in for an exact solution in the rigid limit.
const FINEST_STEP_S: f64 = 2e-6;

/// All exact cases. To add one: a row.
pub const CASES: [Case; 15] = [
    Case {
        name: "roll",
        title: "A sphere rolls down 20° from rest, 1 s",
        source: "uniform acceleration 5/7 g sin α; springs: critically damped oscillator",
        kind: CaseKind::Smooth,
        facets: || plane(20.0),
        setup: |has_springs| lying(20.0, has_springs),
        exact: Some(|setup, has_springs| {
            let way = closed::rolled_way_m(angle(20.0), 1.0, 1.0);
            let sprung = closed::stuck_way_m(setup, angle(20.0), 1.0, 1.0);
            along(setup, angle(20.0), if has_springs { sprung } else { way })
        }),
        ..STILL
    },
    Case {
        name: "slip",
        title: "A sphere slips down 40° with friction 0.2 from rest, 1 s",
        source: "uniform acceleration; springs: friction grows within a millisecond",
        kind: CaseKind::Smooth,
        facets: || plane(40.0),
        setup: |has_springs| slippery(&lying(40.0, has_springs)),
        exact: Some(|setup, has_springs| {
            let (way, spin) = closed::slipped(setup, angle(40.0), 1.0, has_springs);
            let mut measures = along(setup, angle(40.0), way);
            measures.push(CaseMeasure {
                what: "spin (rad/s)",
                exact: -spin,
                scale: spin,
                of: |journey| journey.end.spin_rad_s.x,
            });
            measures
        }),
        ..STILL
    },
    Case {
        name: "skid",
        title: "A sphere pushed with 5 m/s over level ground with friction 0.2: slides, then rolls, 1 s",
        source: "rolls with 5/7 of its speed; springs: gives back what its shear spring holds",
        kind: CaseKind::Smooth,
        facets: || plane(0.0),
        setup: |has_springs| Setup {
            velocity_m_s: Vec3::new(0.0, 5.0, 0.0),
            ..slippery(&lying(0.0, has_springs))
        },
        exact: Some(|setup, has_springs| {
            along(setup, 0.0, closed::skidded(setup, 5.0, 1.0, has_springs).0)
        }),
        ..STILL
    },
    Case {
        name: "bounce",
        title: "A sphere dropped from 1 m with restitution 0.5, two impacts, 1 s",
        source: "springs: closed form of the damped oscillator with gravity (13 digits); rigid: parabolas",
        kind: CaseKind::Impact,
        capture_speed_m_s: 0.05,
        facets: || plane(0.0),
        setup: |_| Setup { centre_m: Vec3::new(0.1, 0.2, 1.5), ..SETUP },
        exact: Some(|_, has_springs| {
            let (z, second) = if has_springs {
                (0.558_838_697_250_74, 0.905_526_162_784_89)
            } else {
                (rigid_bounce_m(), 2.0 * (2.0 / SETUP.gravity_m_s2).sqrt())
            };
            let time_of = |j: &Trajectory| j.impacts.get(1).map_or(f64::NAN, |hit| hit.time_s);
            vec![
                CaseMeasure {
                    what: "height (m)",
                    exact: z,
                    scale: 1.0,
                    of: |j| j.end.position_m.z,
                },
                CaseMeasure { what: "second impact (s)", exact: second, scale: 1.0, of: time_of },
            ]
        }),
    },
    Case {
        name: "oblique",
        title: "A spinning sphere strikes the ground obliquely, 0.2 s",
        source: "springs: explicit Runge-Kutta steps of the law (9 digits); rigid: the same steps in the limit of stiff springs (11 digits)",
        kind: CaseKind::Impact,
        capture_speed_m_s: 0.01,
        facets: || plane(0.0),
        setup: |_| Setup {
            centre_m: Vec3::new(0.0, 0.0, 0.6),
            velocity_m_s: Vec3::new(5.0, 1.0, -5.0),
            spin_rad_s: Vec3::new(3.0, -20.0, 4.0),
            longest_s: 0.2,
            ..SETUP
        },
        exact: Some(|_, has_springs| {
            if has_springs {
                place(0.202_693_999, 0.067_115_667, 0.804_023_327)
            } else {
                place(0.199_939_258_73, 0.066_656_543_12, 0.808_860_491_89)
            }
        }),
    },
    Case {
        name: "fold",
        title: "A sphere strikes a blunt valley of 0.02 rad beside its bottom and presses on both sides, e = 1, 0.05 s",
        source: "springs: Runge-Kutta steps of the energy summed over faces and edge, in the plane (10 digits); rigid: parabolas",
        kind: CaseKind::Impact,
        capture_speed_m_s: 0.0,
        facets: || fold(0.02, 4.0),
        setup: |_| Setup {
            centre_m: Vec3::new(-0.022, 0.1, 0.6),
            velocity_m_s: Vec3::new(2.0, 0.0, -10.0),
            longest_s: 0.05,
            ..elastic()
        },
        exact: Some(|_, has_springs| {
            if has_springs {
                place(0.075_482_999_395_36, 0.1, 0.860_764_330_887_67)
            } else {
                place(0.086_072_144_850_73, 0.1, 0.894_937_577_744)
            }
        }),
    },
    Case {
        name: "rough",
        title: "A sphere of 1 m lands on cells of 0.2 m that are 5 mm uneven, e = 1, 0.1 s",
        source: "springs: Runge-Kutta steps of the energy summed over all triangles, edges and corners (9 digits); rigid: parabolas between touches found by bisection",
        kind: CaseKind::Impact,
        capture_speed_m_s: 0.0,
        facets: || bumpy(12, 0.2, 0.01),
        setup: |_| Setup {
            rock: crate::rock::Rock { radius_m: 1.0, ..SETUP.rock },
            centre_m: Vec3::new(0.03, -0.05, 1.1),
            velocity_m_s: Vec3::new(2.0, 1.0, -10.0),
            longest_s: 0.1,
            ..elastic()
        },
        exact: Some(|_, has_springs| {
            if has_springs {
                place(0.227_171_593_9, 0.051_799_894_8, 1.780_613_200_5)
            } else {
                place(0.227_011_278_831_01, 0.051_903_413_471_17, 1.878_648_278_489_99)
            }
        }),
    },
    Case {
        name: "pivot",
        title: "A sphere tips over an edge from rest at 0.1 rad, friction 30°: rolls, slips, lifts off, 1 s",
        source: "springs: explicit Runge-Kutta steps in polar coordinates; rigid: closed form of slip and lift-off",
        kind: CaseKind::Edge,
        capture_speed_m_s: 0.0,
        facets: roof,
        setup: |has_springs| tipping(30.0, has_springs),
        exact: Some(|setup, has_springs| {
            let rigid = Lift {
                angle_rad: 0.926_860_928_088_68,
                time_s: 0.784_278_576_868_45,
                speed_m_s: 1.715_139_101_983_2,
            };
            tipped(setup, &rigid, has_springs)
        }),
    },
    Case {
        name: "pivot_rough",
        title: "The same without slip until the very end, friction 89°",
        source: "springs: explicit Runge-Kutta steps in polar coordinates; rigid: energy, lifts off at cos θ = 10/17 cos 0.1",
        kind: CaseKind::Edge,
        capture_speed_m_s: 0.0,
        facets: roof,
        setup: |has_springs| tipping(89.0, has_springs),
        exact: Some(|setup, has_springs| {
            let rigid = Lift::by_energy(0.5, TIPPED_RAD, 10.0 / 7.0, 0.790_441_637_957_75);
            tipped(setup, &rigid, has_springs)
        }),
    },
    Case {
        name: "pivot_smooth",
        title: "The same without friction",
        source: "springs: explicit Runge-Kutta steps in polar coordinates; rigid: energy, lifts off at cos θ = 2/3 cos 0.1",
        kind: CaseKind::Edge,
        capture_speed_m_s: 0.0,
        facets: roof,
        setup: |has_springs| tipping(0.0, has_springs),
        exact: Some(|setup, has_springs| {
            let rigid = Lift::by_energy(0.5, TIPPED_RAD, 2.0, 0.641_750_884_357_65);
            tipped(setup, &rigid, has_springs)
        }),
    },
    Case {
        name: "groove",
        title: "A sphere rolls down a right-angled groove that falls at 20°, two contacts, 1 s",
        source: "uniform acceleration g sin α/(1 + 4/5); springs: over-damped oscillator",
        kind: CaseKind::Smooth,
        facets: || tilted(make::v_groove(4.0, angle(45.0)), 20.0),
        setup: in_groove,
        exact: Some(|setup, has_springs| {
            let way = closed::rolled_way_m(angle(20.0), 2.0, 1.0);
            let sprung = closed::stuck_way_m(setup, angle(20.0), 2.0, 1.0);
            along(setup, angle(20.0), if has_springs { sprung } else { way })
        }),
        ..STILL
    },
    Case {
        name: "stairs",
        title: "A sphere of 0.2 m hops down stairs: impacts on treads and edges, 2 s",
        source: "no closed form: the same law at a tolerance of 1e-10 m/s (rigid: a step of 2e-6 s)",
        kind: CaseKind::Stairs,
        capture_speed_m_s: 0.05,
        facets: || make::stairs(20, 0.3, 0.5, 3.0),
        setup: |_| {
            let rock = crate::rock::Rock { radius_m: 0.2, ..SETUP.rock };
            Setup {
                rock,
                centre_m: Vec3::new(0.1, 0.15, 0.5),
                velocity_m_s: Vec3::new(0.0, 1.0, 0.0),
                longest_s: 2.0,
                ..SETUP
            }
        },
        exact: None,
    },
    blocks::SLIDES,
    thrown::THROWN,
    blocks::ROLLS,
];

/// What rows have in common.
const STILL: Case = Case {
    name: "",
    title: "",
    source: "",
    kind: CaseKind::Smooth,
    capture_speed_m_s: 0.02,
    facets: Vec::new,
    setup: |_| SETUP,
    exact: None,
};
