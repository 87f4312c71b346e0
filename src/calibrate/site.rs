//! One scene of a calibration and what was measured on it.

use super::beside::read_ways;
use super::computed::{Computed, ObservedWays, drawn_from};
use super::own::{OwnPlaces, ThrownFrom};
use super::parts::{few, parts_of, rows_of};
use super::{CalibrationStage, Ends, put_all, refuse_weights};
use crate::ensemble::Ensemble;
use crate::error::Result;
use crate::hazard::{
    Agreement, EndDistances, ObservedPath, OpenEnds, Row, RunoutDistances, Weighted, effective,
    rank,
};
use crate::plan::{Part, Plan};
use crate::random::RandomStream;
use crate::scene::{CalibrateTable, CalibrationScore, Scene, VaryTable};
use crate::simulation::{Scratch, simulate_release};
use crate::terrain::Terrain;
use std::path::Path;

/// One scene and what was measured on it.
pub(super) struct CalibrationSite {
    scene: Scene,
    measured: Vec<ObservedPath>,
    /// What is to be said of those beside the terrain.
    beside: Option<String>,
    /// Least runout of a computed rock that is compared (m).
    least_runout_m: Option<f64>,
    /// The block that each measured end belongs to; empty if the file does not tell.
    blocks: Vec<String>,
    /// The part that each measured end is held out with.
    part: Vec<usize>,
    terrain: Option<Terrain>,
    /// Rows of the measured ends that stand beside the same computed ones: those of a block, or all.
    groups: Vec<Vec<usize>>,
    /// What a fit brings near.
    score: CalibrationScore,
    /// What the plan says of the shapes of its rocks.
    shapes: Vec<String>,
    /// Where measured rocks were released; none unless the scene releases from all of these places.
    own: Option<OwnPlaces>,
}

impl CalibrationSite {
    pub(super) fn of(
        scene: &Scene,
        (releases, parts): (usize, usize),
        score: CalibrationScore,
    ) -> Result<Self> {
        scene.refuse_world("`calibrate`")?;
        let ends = scene.calibrate.as_ref().map(CalibrateTable::measured);
        let (terrain, _) = scene.read_terrain()?;
        let (measured, beside, blocks, part) = match &ends {
            Some(ends) => {
                let deposits = &ends.file;
                let (measured, beside) = read_ways(ends, &terrain)?;
                let blocks = ObservedPath::read_blocks(deposits)?;
                let part =
                    parts_of(measured.len(), &blocks, parts).ok_or_else(|| few(deposits, parts))?;
                (measured, beside, blocks, part)
            }
            None => (Vec::new(), None, Vec::new(), Vec::new()),
        };
        let asked = &scene.release;
        let places: Vec<ThrownFrom> = match &asked.points_m {
            Some(points) => points.iter().map(|point| (point.at_m, None)).collect(),
            None => asked.blocks.iter().map(|row| (row.at_m, row.block.as_deref())).collect(),
        };
        // a table may name its rows otherwise than the ends: then places alone tell
        let own = OwnPlaces::of(&measured, &blocks, &places)
            .or_else(|| OwnPlaces::of(&measured, &[], &places));
        let mut scene = bare(scene, releases);
        if own.is_some() {
            // every place as often as any other
            scene.release.count = releases.next_multiple_of(places.len());
        }
        let (shapes, terrain, all) = (Vec::new(), Some(terrain), (0..measured.len()).collect());
        let groups = vec![all];
        let least_runout_m = ends.and_then(|ends| ends.least_runout_m);
        let mut site = Self {
            scene,
            measured,
            beside,
            least_runout_m,
            blocks,
            part,
            terrain,
            groups,
            score,
            shapes,
            own,
        };
        let blocks: Vec<Vec<usize>> =
            site.rows_of_blocks().into_iter().map(|(_, rows)| rows).collect();
        if !blocks.is_empty() {
            site.groups = blocks;
        }
        Ok(site)
    }

    pub(super) fn title(&self) -> String {
        self.scene.title.clone()
    }

    pub(super) fn seed(&self) -> u64 {
        self.scene.seed
    }

    pub(super) fn file(&self) -> &Path {
        &self.scene.file
    }

    /// Least runout of a computed rock that is compared (m); none as short as can be.
    pub(super) fn least_runout_m(&self) -> Option<f64> {
        self.least_runout_m
    }

    /// What is to be said of measured ends beside the terrain, if there are any.
    pub(super) fn beside(&self) -> Option<&str> {
        self.beside.as_deref()
    }

    /// What the plan says of the shapes of its rocks; known once it has computed.
    pub(super) fn shapes(&self) -> &[String] {
        &self.shapes
    }

    /// Whether it is known which throws are of one block.
    pub(super) fn knows_blocks(&self) -> bool {
        !self.blocks.is_empty()
    }

    pub(super) fn measured(&self) -> &[ObservedPath] {
        &self.measured
    }

    /// Computes all releases of a stage with these values.
    pub(super) fn compute(
        &mut self,
        (vary, values): (&[VaryTable], &[f64]),
        stage: CalibrationStage,
        ensemble: &Ensemble,
    ) -> Result<Computed> {
        // a copy: a value that only this trial leaves as it was must be that of the scene and not of the trial before
        let mut scene = self.scene.clone();
        put_all(&mut scene, vary, values)?;
        scene.seed = stage.seed(self.scene.seed);
        scene.release.count = stage.releases(self.scene.release.count);
        let terrain = match self.terrain.take() {
            Some(terrain) => terrain,
            None => scene.read_terrain()?.0,
        };
        let plan = Plan::compile(&scene, terrain)?;
        if let Part::Kept(year) = &plan.year {
            // of zones that were read meanwhile
            refuse_weights(&scene, Some(&year.frequency))?;
        }
        let origin_m = plan.terrain.origin_m;
        let (mut ways, mut stayed) = (ObservedWays::new(), Vec::new());
        let one =
            |index: usize, scratch: &mut Scratch| simulate_release(&plan, index, None, scratch);
        for falls in ensemble.in_chunks(0..plan.count, Scratch::default, one) {
            for fall in falls? {
                match ObservedPath::of(&Row::of(&fall, origin_m)) {
                    Some(way) if way.ran(self.least_runout_m) => ways.push((fall.index, way)),
                    Some(_) => stayed.push(fall.index),
                    None => {}
                }
            }
        }
        plan.releases.shapes().clone_into(&mut self.shapes);
        let releases = (plan.count, self.classes(&plan));
        self.terrain = Some(plan.terrain);
        let mut computed = Computed { ways, stayed, releases, apart: Vec::new() };
        if self.score == CalibrationScore::Ends {
            computed.apart = self.apart(&computed);
        }
        Ok(computed)
    }

    /// How far the computed ends lie from the measured ones, for each way in which open rocks may have ended.
    fn apart(&self, computed: &Computed) -> Vec<EndDistances> {
        let is_open = computed.ways.iter().any(|(_, way)| way.open.is_some());
        let ways = if is_open { &OpenEnds::ALL[..] } else { &[OpenEnds::Seen] };
        let one = |how: &OpenEnds| {
            let beside =
                |rows: &[usize]| how.placed(&self.ends(rows), self.weighted(computed, rows));
            EndDistances::of(&self.measured, &self.groups, beside)
        };
        ways.iter().map(one).collect()
    }

    /// How many classes the releases take in turn: common places of release, or strata of size and source.
    fn classes(&self, plan: &Plan) -> usize {
        let strata = || match &plan.year {
            Part::Kept(year) => year.frequency.strata().len(),
            Part::LeftOut(_) => 1,
        };
        self.own.as_ref().map_or_else(strata, OwnPlaces::in_turn).max(1)
    }

    /// Energy distance of some measured ends from the computed ones (m), the least and the most of the ways in which open rocks may have ended; beyond
    /// all numbers where nothing was computed beside one of them. None where a fit is not scored by it.
    fn ends_m(&self, computed: &Computed, rows: &[usize]) -> Option<[f64; 2]> {
        let each = computed.apart.iter().map(|apart| {
            let ends_m = apart.energy_m(&self.measured, &self.groups, rows);
            // what is no number may have any sign, and would count as the nearest
            if ends_m.is_nan() { f64::INFINITY } else { ends_m }
        });
        let least = each.clone().reduce(f64::min)?;
        Some([least, each.fold(least, f64::max)])
    }

    /// Compares some of the ends, of which there must be one.
    pub(super) fn compare(&self, computed: &Computed, of: Ends) -> Agreement {
        let rows = self.rows(of);
        let found = Agreement::of_weighted(&self.ends(&rows), &self.weighted(computed, &rows))
            .unwrap_or_else(|| Agreement::of_nothing(&self.ends(&rows)));
        let stayed = self.stayed(computed, &rows);
        let ends_m = self.ends_m(computed, &rows);
        let most_m = ends_m.filter(|[least, most]| least < most).map(|[_, most]| most);
        Agreement { stayed, ends_m: ends_m.map(|[least, _]| least), ends_most_m: most_m, ..found }
    }

    /// Rocks that would stand beside some of the ends, had they run.
    fn stayed(&self, computed: &Computed, rows: &[usize]) -> usize {
        let Some(own) = &self.own else { return computed.stayed.len() };
        let is_beside = |index: &&usize| {
            let place = own.of_release(**index);
            place.is_some() && rows.iter().any(|&row| Some(own.of_end[row]) == place)
        };
        computed.stayed.iter().filter(is_beside).count()
    }

    /// Rows of some of the ends.
    fn rows(&self, of: Ends) -> Vec<usize> {
        let wanted = |row: &usize| match of {
            Ends::Without(part) => self.part[*row] != part,
            Ends::Only(part) => self.part[*row] == part,
            Ends::All => true,
        };
        (0..self.measured.len()).filter(wanted).collect()
    }

    /// Measured ends of some rows.
    pub(super) fn ends(&self, rows: &[usize]) -> Vec<ObservedPath> {
        rows.iter().map(|&row| self.measured[row]).collect()
    }

    /// Computed ways with what they weigh beside some measured ends: those from the place of one weigh as much as it, all
    /// together, and those from other places nothing. Without common places they all weigh the same.
    pub(super) fn weighted(&self, computed: &Computed, rows: &[usize]) -> Vec<Weighted> {
        let Some(own) = &self.own else {
            return computed.ways.iter().map(|(_, way)| (*way, 1.0)).collect();
        };
        let places: Vec<_> =
            computed.ways.iter().map(|(index, _)| (own.of_release(*index), 1.0)).collect();
        let ways = computed.ways.iter().map(|(_, way)| *way);
        ways.zip(own.weights(rows, &places)).collect()
    }

    /// Distance of some measured ends from the computed ones, times their number: the energy distance (m), or that of
    /// the distributions of runout after Kolmogorov and Smirnov (–), which is 1 where nothing was computed. The least and the most that it may be, as
    /// open rocks have ended.
    pub(super) fn distance(&self, computed: &Computed, rows: &[usize]) -> [f64; 2] {
        let measured: Vec<Weighted> = rows.iter().map(|&row| (self.measured[row], 1.0)).collect();
        let ks = || {
            let found = RunoutDistances::of(&measured, &self.weighted(computed, rows));
            found.map_or([1.0; 2], |found| found.ks)
        };
        self.ends_m(computed, rows).unwrap_or_else(ks).map(|far| rows.len() as f64 * far)
    }

    /// Where some measured ends lie among the computed ones of their own places: mean rank, which is 0.5 where they are
    /// alike, and the largest distance of the ranks from even ones (–). None without common places.
    pub(super) fn ranks(&self, computed: &Computed, rows: &[usize]) -> Option<[f64; 2]> {
        let own = self.own.as_ref()?;
        let mut of_place = vec![Vec::new(); self.measured.len()];
        for (index, way) in &computed.ways {
            own.of_release(*index).into_iter().for_each(|place| of_place[place].push(*way));
        }
        let rank = |&row: &usize| rank(&self.measured[row], &of_place[own.of_end[row]]);
        let mut ranks: Vec<f64> = rows.iter().filter_map(rank).collect();
        ranks.sort_by(f64::total_cmp);
        let n = ranks.len() as f64;
        let mean = ranks.iter().sum::<f64>() / n;
        let off = ranks.iter().enumerate().map(|(k, rank)| {
            let (below, upto) = (k as f64 / n, (k as f64 + 1.0) / n);
            (rank - below).abs().max((rank - upto).abs())
        });
        let off = off.fold(0.0, f64::max);
        (n > 0.0).then_some([mean, off])
    }

    /// Rows of each block; none where computed ends cannot be told apart by their places.
    pub(super) fn rows_of_blocks(&self) -> Vec<(&str, Vec<usize>)> {
        let is_told = self.own.is_some() && self.knows_blocks();
        if is_told { rows_of(self.measured.len(), &self.blocks) } else { Vec::new() }
    }

    /// Independent ends that the measured ones are worth.
    pub(super) fn effective(&self) -> f64 {
        self.worth_of(&self.rows(Ends::All))
    }

    /// Independent ends that some of the measured ones are worth, which these alone decide: a fit to them knows no other.
    fn worth_of(&self, rows: &[usize]) -> f64 {
        let runouts: Vec<f64> = rows.iter().map(|&row| self.measured[row].runout_m()).collect();
        let blocks: Vec<String> =
            rows.iter().filter_map(|&row| self.blocks.get(row)).cloned().collect();
        effective(&runouts, &blocks)
    }

    /// As many of these measured ends as they are worth, drawn from them with replacement: their rows.
    pub(super) fn redraw(&self, of: Ends, random: &mut RandomStream) -> Vec<usize> {
        let rows = self.rows(of);
        let count = (self.worth_of(&rows).round() as usize).max(2);
        drawn_from(&rows, count, random)
    }
}

/// The scene without anything that a trial has no use for.
fn bare(scene: &Scene, releases: usize) -> Scene {
    let mut bare = scene.clone();
    bare.release.count = releases;
    (bare.record.paths, bare.record.impacts) = (Some(0), Some(false));
    (bare.lines, bare.barriers, bare.maps) = (Vec::new(), Vec::new(), None);
    bare
}
