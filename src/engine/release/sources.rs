//! Release places and sources, and the rock sizes of each source.

use super::{ReleasePlace, Releases};
use crate::error::{Error, Result};
use crate::frequency::{Frequency, radius_of_m3};
use crate::random::{Purpose, stream, unit};
use crate::scene::{Area, Corner, Polyline, ReleasePoint, Scene, Zones};
use crate::terrain::Terrain;

impl Releases {
    pub(super) fn place_of_scene(scene: &Scene) -> Result<ReleasePlace> {
        let table = &scene.release;
        let drawn = (&table.points_m, &table.line_m, &table.polygon_m);
        let place = match &table.zone_list {
            None => ReleasePlace::one_of(drawn),
            Some(zones) if drawn == (&None, &None, &None) => {
                Some(ReleasePlace::Zones(zones.clone()))
            }
            Some(_) => None,
        };
        place.ok_or_else(|| {
            let remedy = "write exactly one of points_m, line_m, polygon_m, table and zones";
            Error::input(&scene.file, "[release]", "found none or several", remedy)
        })
    }

    /// Refuses a point or corner without ground below.
    pub(super) fn check_ground(&self, terrain: &Terrain) -> Result<()> {
        for (k, place) in self.places.iter().enumerate() {
            let table = if self.places.len() > 1 {
                format!("[[frequency.sources]] #{}", k + 1)
            } else {
                "[release]".to_owned()
            };
            for (number, (who, corner)) in place.corners_m().into_iter().enumerate() {
                self.check_corner(terrain, (place, number), corner, &format!("{table} {who}"))?;
            }
        }
        Ok(())
    }

    /// Number of first releases among which every fixed point occurs.
    pub(super) fn fixed_cycle(&self) -> usize {
        let points = |place: &ReleasePlace| {
            if let ReleasePlace::Points(all) = place { all.len() } else { 0 }
        };
        let strata = self.frequency.as_ref().map_or(1, |frequency| frequency.strata().len());
        strata * self.places.iter().map(points).max().unwrap_or(0)
    }

    /// Place of a release, and its turn among the releases of that place.
    pub(super) fn place_of(&self, index: usize) -> (&ReleasePlace, usize) {
        match &self.frequency {
            Some(frequency) => {
                let source = frequency.stratum(index).source.min(self.places.len() - 1);
                (&self.places[source], frequency.turn(index))
            }
            None => (&self.places[0], index),
        }
    }

    /// Radius of a rock (m), from its source, its table or else the scene.
    pub(super) fn draw_radius_m(&self, index: usize) -> f64 {
        if !self.radii_m.is_empty() {
            return self.radii_m[self.place_of(index).1 % self.radii_m.len()];
        }
        let mut random = stream(self.seed, Purpose::Size, index);
        let own = self.frequency.as_ref().filter(|frequency| frequency.draws_volumes());
        let volume_m3 =
            own.and_then(|frequency| frequency.stratum(index).quantile_m3(unit(&mut random)));
        volume_m3.map_or_else(|| self.radius_m.draw(&mut random), radius_of_m3)
    }

    /// The sources, their size distributions, and what is asked per year; `None` if the scene has
    /// none.
    pub fn frequency(&self) -> Option<&Frequency> {
        self.frequency.as_ref()
    }

    /// The share of a zone in all releases (–).
    pub fn share_of_zone(&self, zones: &Zones, zone: usize) -> f64 {
        match self.frequency.as_ref().filter(|_| self.zones_are_sources) {
            None => zones.share(zone),
            Some(frequency) => {
                let strata = frequency.strata();
                let own = strata.iter().filter(|stratum| stratum.source == zone).count();
                own as f64 / strata.len() as f64
            }
        }
    }

    /// Whether zones are sources, each with its own frequency.
    pub fn zones_are_sources(&self) -> bool {
        self.zones_are_sources
    }

    /// Where rocks are released: one place, or one for each source.
    pub fn places(&self) -> &[ReleasePlace] {
        &self.places
    }
}

impl ReleasePlace {
    /// The place that is given; `None` if there is none or more than one.
    pub(super) fn one_of(
        given: (&Option<Vec<ReleasePoint>>, &Option<Polyline>, &Option<Area>),
    ) -> Option<Self> {
        match given {
            (Some(points), None, None) => Some(Self::Points(points.clone())),
            (None, Some(line), None) => Some(Self::Line(line.clone())),
            (None, None, Some(area)) => Some(Self::Area(area.clone())),
            _ => None,
        }
    }

    /// Its points or corners in plan view (m), map coordinates, each with its key and entry in the
    /// scene.
    fn corners_m(&self) -> Vec<(String, Corner)> {
        let numbered = |key: &str, corners: &mut dyn Iterator<Item = Corner>| {
            let named = |(number, corner)| (format!("{key}, entry {number}"), corner);
            (1..).zip(corners).map(named).collect()
        };
        match self {
            Self::Points(points) => {
                numbered("points_m", &mut points.iter().map(|point| point.at_m))
            }
            Self::Line(line) => numbered("line_m", &mut line.corners_m().iter().copied()),
            Self::Area(area) => numbered("polygon_m", &mut area.corners_m().iter().copied()),
            Self::Zones(zones) => {
                let each = zones.list().iter().flat_map(|zone| {
                    let who = format!("zones, feature {}", zone.feature);
                    zone.corners_m().into_iter().map(move |corner| (who.clone(), corner))
                });
                each.collect()
            }
        }
    }
}
