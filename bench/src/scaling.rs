//! Cost against the number of rocks that share one world: spheres fall onto the ridge between two open boxes.

use crate::speed::machine::status_bytes;
use rockfall::contact::pair::BondStrength;
use rockfall::ground::Ground;
use rockfall::math;
use rockfall::plan::{Recorders, RestRule};
use rockfall::release::Release;
use rockfall::rock::{Motion, Rock, Vec3};
use rockfall::simulation::{
    Observer, PairMaterial, RecordOptions, RunSettings, Stop, Trajectory, WorldStats,
    simulate_world,
};
use rockfall::solver::{RIGID_STEP_S, Scheme, Settings};
use rockfall::study::bench::{GRAVITY_M_S2, terrain};
use rockfall::study::processor_time::ProcessorTime;
use rockfall::terrain::Terrain;
use rockfall::terrain::make::containers;
use std::fs;
use std::sync::atomic::AtomicBool;

/// The sphere of the paper's example 3.
const ROCK: Rock = Rock { radius_m: 0.05, density_kg_m3: 2700.0 };
/// Table 1, with a restitution of 0.5.
const GROUND: Ground = Ground {
    rolling_friction: 0.05,
    ..Ground::smooth([1e9, 0.25e9], std::f64::consts::FRAC_PI_6, Some(0.5))
};
/// Distance of the spheres at the start (m), as in example 3.
const SPACING_M: f64 = 0.12;
/// Local error of the default scheme (m/s).
const TOLERANCE_M_S: f64 = 0.05;
/// Step of the paper, and longest step of `rigid` as the plan has it (s).
const STEPS_S: (f64, f64) = (1e-5, RIGID_STEP_S);

/// A part of the story. That of a sphere is the same in all worlds: what is compared between them is the same part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Before the first spheres arrive.
    Falling,
    /// Layer upon layer arrives: impacts everywhere.
    Impacts,
    /// The heaps in the boxes come to rest.
    Settling,
}

impl Phase {
    /// In the order of the story.
    pub const ALL: [Self; 3] = [Self::Falling, Self::Impacts, Self::Settling];

    /// Begin and end (s).
    pub const fn times_s(self) -> (f64, f64) {
        match self {
            Self::Falling => (0.0, 0.25),
            Self::Impacts => (0.4, 0.6),
            Self::Settling => (1.5, 1.8),
        }
    }

    /// In tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Falling => "falling",
            Self::Impacts => "impacts",
            Self::Settling => "settling",
        }
    }
}

/// What one part of the story took.
#[derive(Debug, Clone, Copy)]
pub struct Cost {
    /// Which part.
    pub phase: Phase,
    /// Time followed in it (s).
    pub simulated_s: f64,
    /// Processor time of one thread (s).
    pub processor_s: f64,
    /// Counted in it.
    pub census: WorldStats,
}

impl Cost {
    /// Processor time by simulated time (–).
    pub fn rate(&self) -> f64 {
        self.processor_s / self.simulated_s
    }

    /// Processor time of one window of time, in which the whole world goes on (s).
    pub fn window_s(&self) -> f64 {
        self.processor_s / self.census.windows.max(1) as f64
    }

    /// Processor time of one step of one rock in contact (s), everything else included.
    pub fn rock_step_s(&self) -> f64 {
        self.processor_s / self.census.rock_steps.max(1) as f64
    }
}

/// One world of the study.
#[derive(Debug, Clone)]
pub struct World {
    /// Scheme.
    pub scheme: Scheme,
    /// Number of spheres.
    pub spheres: usize,
    /// Time followed (s).
    pub simulated_s: f64,
    /// Processor time of one thread (s).
    pub processor_s: f64,
    /// Its parts, those that were followed to their end.
    pub costs: Vec<Cost>,
    /// Largest memory of the process on the way, less what it held before the first world (byte); `None` where the system does not say.
    pub memory_bytes: Option<u64>,
    /// What it took.
    pub census: WorldStats,
    /// Spheres that failed or left the boxes' surroundings.
    pub lost: usize,
    /// Spheres at rest at the end.
    pub at_rest: usize,
    /// Deepest overlap of two spheres at the end, over the radius (–).
    pub overlap: f64,
    /// Fastest sphere on the way, and the speed of a free fall from the highest one to the floor (m/s): impacts between
    /// equal spheres that lose energy make none faster.
    pub fastest_m_s: (f64, f64),
}

impl World {
    /// Time of one step of all spheres in a part of the story (s): while they fall, of a window in which all leap; else as
    /// many times that of one step of one sphere. Everything else that was done is in it.
    pub fn step_s(&self, phase: Phase) -> Option<f64> {
        let cost = self.cost(phase)?;
        let all = self.spheres as f64 * cost.rock_step_s();
        Some(if phase == Phase::Falling { cost.window_s() } else { all })
    }

    /// One part of its story, if it was followed to its end.
    pub fn cost(&self, phase: Phase) -> Option<&Cost> {
        self.costs.iter().find(|cost| cost.phase == phase)
    }
}

/// Processor time and counts at the begins and ends of the parts.
struct Marks {
    clock: ProcessorTime,
    /// Time, processor time (s) and counts at the first window's end not before each begin and end.
    seen: Vec<(f64, f64, WorldStats)>,
}

impl Marks {
    fn times_s() -> impl Iterator<Item = f64> {
        Phase::ALL.into_iter().flat_map(|phase| <[f64; 2]>::from(phase.times_s()))
    }

    fn see(&mut self, now_s: f64, census: &WorldStats) {
        // The world may have gone back.
        self.seen.retain(|(time_s, ..)| *time_s <= now_s);
        let passed = Self::times_s().take_while(|mark| *mark <= now_s).count();
        if passed > self.seen.len() {
            let at = (now_s, self.clock.seconds(), *census);
            self.seen.resize(passed, at);
        }
    }

    fn costs(&self) -> Vec<Cost> {
        let pairs = Phase::ALL.into_iter().zip(self.seen.chunks_exact(2));
        let cost = |(phase, ends): (Phase, &[(f64, f64, WorldStats)])| Cost {
            phase,
            simulated_s: ends[1].0 - ends[0].0,
            processor_s: ends[1].1 - ends[0].1,
            census: ends[1].2.since(&ends[0].2),
        };
        pairs.map(cost).collect()
    }
}

/// Example 3 with `spheres` instead of 48, boxes and grid larger in plan, for `longest_s` (s). Depth and layers stay: the
/// story of a sphere is the same in all worlds.
pub fn world(scheme: Scheme, spheres: usize, (longest_s, before): (f64, Option<u64>)) -> World {
    let size = (spheres as f64 / 48.0).sqrt();
    let terrain = terrain(boxes(size));
    let step = Settings {
        scheme,
        tolerance_m_s: if scheme == Scheme::Rigid { 0.0 } else { TOLERANCE_M_S },
        step_s: if scheme == Scheme::Rigid { STEPS_S.1 } else { STEPS_S.0 },
        shear_memory: true,
        impact_kernels: true,
        rigid_heaps: true,
        corner_way: rockfall::solver::CORNER_WAY,
        capture_speed_m_s: None,
    };
    let course = RunSettings {
        terrain: &terrain,
        gravity_m_s2: GRAVITY_M_S2,
        step: &step,
        rest: RestRule { speed_m_s: 0.02, time_s: 0.3 },
        longest_s,
        recorders: Recorders::default(),
        seed: 1,
    };
    let releases = heap(spheres, size, terrain.origin_m);
    let answer = PairMaterial {
        ground: GROUND,
        strength: BondStrength { tensile_pa: 0.0, cohesion_pa: 0.0 },
    };
    let keep = |_| RecordOptions { path_step_s: None, impacts: false };
    let never = AtomicBool::new(false);
    // Linux forgets the largest memory so far when asked to; where it cannot, the number is left out.
    let forgot = fs::write("/proc/self/clear_refs", "5").is_ok();
    let mut marks = Marks { clock: ProcessorTime::begin(), seen: Vec::new() };
    marks.see(0.0, &WorldStats::default());
    let see = |now_s: f64, census: &WorldStats| marks.see(now_s, census);
    let (falls, census) =
        simulate_world(&course, &releases, &answer, keep, Observer { stop: &never, observe: see })
            .unwrap_or_default();
    let processor_s = marks.clock.seconds();
    let most = resident_bytes("VmHWM:").filter(|_| forgot);
    let memory_bytes = most.zip(before).map(|(most, before)| most.saturating_sub(before));
    let lost = |fall: &&Trajectory| matches!(fall.stop, Stop::Failed(_) | Stop::LeftTerrain);
    World {
        scheme,
        spheres,
        simulated_s: longest_s,
        processor_s,
        costs: marks.costs(),
        memory_bytes,
        census,
        lost: falls.iter().filter(lost).count() + spheres - falls.len(),
        at_rest: falls.iter().filter(|fall| fall.stop == Stop::AtRest).count(),
        overlap: deepest_overlap(&falls),
        fastest_m_s: (fastest_m_s(&falls), fall_m_s(&releases, &terrain)),
    }
}

fn fastest_m_s(falls: &[Trajectory]) -> f64 {
    falls.iter().map(|fall| fall.extremes.speed_m_s).fold(0.0, f64::max)
}

fn fall_m_s(releases: &[Release], terrain: &Terrain) -> f64 {
    let highest = releases
        .iter()
        .map(|release| release.motion.position_m.z)
        .fold(f64::NEG_INFINITY, f64::max);
    let lowest = terrain.vertices_m.iter().map(|vertex| vertex.z).fold(f64::INFINITY, f64::min);
    (2.0 * GRAVITY_M_S2 * (highest - lowest - ROCK.radius_m)).sqrt()
}

/// The two boxes, on a floor that catches what falls beside them.
fn boxes(size: f64) -> Vec<rockfall::terrain::stl::Facet> {
    let mut facets = containers(0.5 * size, 0.3125 * size, 0.625, 0.125);
    let at = |x: f64, y: f64| Vec3::new(4.0 * size * x, 4.0 * size * y, -0.125);
    facets.push([at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0)]);
    facets.push([at(-1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)]);
    facets
}

/// Spheres in a grid above the ridge, each moved by up to a millimetre: columns of spheres exactly above each other
/// would balance.
fn heap(spheres: usize, size: f64, origin_m: Vec3) -> Vec<Release> {
    use rockfall::random::{Purpose, stream, unit};
    let wide = (4.0 * size).ceil() as usize;
    let middle = 0.5 * (wide as f64 - 1.0);
    let mut random = stream(1, Purpose::Impacts, 0);
    let release = |k: usize| {
        let cell = [(k % wide) as f64 - middle, (k / wide % wide) as f64 - middle];
        let grid = Vec3::new(cell[0], cell[1], (k / (wide * wide)) as f64) * SPACING_M;
        let off = Vec3::from_fn(|_, _| 1e-3 * (2.0 * unit(&mut random) - 1.0));
        let position_m = grid + off + Vec3::z() * 0.875 - origin_m;
        let still = Vec3::zeros();
        let motion = Motion { time_s: 0.0, position_m, velocity_m_s: still, spin_rad_s: still };
        Release { rock: ROCK, motion, grounds: vec![GROUND] }
    };
    (0..spheres).map(release).collect()
}

/// Over the radius (–).
fn deepest_overlap(falls: &[Trajectory]) -> f64 {
    use rockfall::solver::island::broad_phase::{Ball, overlapping};
    let ball = |fall: &Trajectory| Ball { centre: fall.end.position_m, radius: fall.rock.radius_m };
    let balls: Vec<Ball> = falls.iter().map(ball).collect();
    let depth = |(a, b): &(u32, u32)| {
        let [a, b] = [a, b].map(|k| &balls[*k as usize]);
        a.radius + b.radius - (a.centre - b.centre).norm()
    };
    overlapping(&balls).iter().map(depth).fold(0.0, f64::max) / ROCK.radius_m
}

/// Memory that the process holds (byte).
pub fn resident_now() -> Option<u64> {
    resident_bytes("VmRSS:")
}

/// A line of `/proc/self/status` (byte).
fn resident_bytes(key: &str) -> Option<u64> {
    status_bytes("/proc/self/status", key)
}

/// Exponent `b` of `y ~ xᵇ` by least squares over the logarithms; `None` below two points.
pub(crate) fn exponent(points: &[(f64, f64)]) -> Option<f64> {
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (math::ln(*x), math::ln(*y))).collect();
    let count = logs.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let across: f64 = logs.iter().map(|p| (p.0 - x).powi(2)).sum();
    let along: f64 = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    (across > 0.0).then(|| along / across)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponent_of_a_power_is_found() {
        let points = [1.0f64, 10.0, 300.0].map(|x| (x, 7.0 * x.powf(1.25)));
        assert!((exponent(&points).unwrap() - 1.25).abs() < 1e-12);
        assert_eq!(exponent(&points[..1]), None);
    }

    /// A handful of spheres lands in the boxes: none is lost, every step settles, and the parts are those of the whole.
    #[test]
    fn a_small_world_is_counted() {
        for scheme in [Scheme::Adaptive, Scheme::Rigid] {
            is_counted(&world(scheme, 12, (0.61, None)));
        }
    }

    fn is_counted(world: &World) {
        assert_eq!((world.lost, world.census.unsettled), (0, 0));
        assert!(world.census.rock_steps >= world.census.steps && world.census.windows > 0);
        assert!(world.census.largest <= 12);
        // the static penetration is 1.4e-8 m
        assert!(world.overlap < 1e-4, "{:e}", world.overlap);
        let phases: Vec<Phase> = world.costs.iter().map(|cost| cost.phase).collect();
        assert_eq!(phases, [Phase::Falling, Phase::Impacts]);
        for cost in &world.costs {
            let (from, to) = cost.phase.times_s();
            // windows are at most 0.02 s long
            assert!((cost.simulated_s - (to - from)).abs() < 0.02, "{cost:?}");
            assert!(cost.processor_s > 0.0 && cost.processor_s < world.processor_s);
            assert!(cost.census.steps <= world.census.steps);
        }
        let (fastest, fall) = world.fastest_m_s;
        // 0.95 m from the lowest layer's bottom to the floor
        assert!(fastest > 3.0 && fastest < fall && fall < 5.0, "{fastest} {fall}");
        let steps = |phase| world.cost(phase).unwrap().census.steps;
        assert!(steps(Phase::Impacts) > 0);
        assert!(steps(Phase::Falling) + steps(Phase::Impacts) <= world.census.steps);
    }

    /// Where the world goes back, what was seen of the time after that is seen again.
    #[test]
    fn marks_go_back_with_the_world() {
        let mut marks = Marks { clock: ProcessorTime::begin(), seen: Vec::new() };
        let counted = |windows| WorldStats { windows, ..WorldStats::default() };
        for (now_s, windows) in [(0.0, 0), (0.26, 1), (0.41, 2), (0.37, 3), (0.42, 4), (0.6, 5)] {
            marks.see(now_s, &counted(windows));
        }
        let costs = marks.costs();
        assert_eq!(costs.iter().map(|cost| cost.census.windows).collect::<Vec<_>>(), [1, 1]);
        assert!((costs[1].simulated_s - 0.18).abs() < 1e-12);
    }
}
