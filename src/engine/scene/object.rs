//! `[[objects]]`: what rocks may hit, and who is there.

use super::check::{Allowed, Checked, Complaint, number, optional};
use super::places::{Area, Polyline};
use serde::Deserialize;

/// Something that rocks may hit: a road, a path, a house.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with name and points_m or polygon_m")]
pub struct ObjectTable {
    /// Name in the results.
    pub name: String,
    /// Its middle line in map coordinates (m); needs `width_m`.
    pub points_m: Option<Polyline>,
    /// Its outline in map coordinates (m).
    pub polygon_m: Option<Area>,
    /// Width of a line (m), 0 or more.
    pub width_m: Option<f64>,
    /// Share of the time that a person is there (–), 0..1.
    pub occupancy: Option<f64>,
    /// Probability that a person who is hit dies (–), 0..1.
    pub vulnerability: Option<f64>,
    /// Persons: of a house those who live in it, on a road those in one vehicle (–), positive.
    pub persons: Option<f64>,
    /// Traffic along a line.
    pub vehicles: Option<VehiclesTable>,
}

/// Traffic on a road.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with per_day, speed_km_h and length_m")]
pub struct VehiclesTable {
    /// Vehicles a day (–), positive.
    pub per_day: f64,
    /// Their speed (km/h), positive.
    pub speed_km_h: f64,
    /// Their length (m), positive.
    pub length_m: f64,
    /// How often a day the person passes whose individual risk is asked for (–), positive.
    pub own_per_day: Option<f64>,
}

/// Way in a day at 1 km/h (m).
const METRES_A_DAY_OF_A_KM_H: f64 = 24e3;

impl ObjectTable {
    pub(super) fn check(&self) -> Checked {
        match (&self.points_m, &self.polygon_m, self.width_m) {
            (Some(_), None, Some(width_m)) => {
                number("width_m", width_m, Allowed::NotNegative, "a road is near 6")?;
            }
            (Some(_), None, None) => {
                return Err(Complaint::missing(
                    "width_m",
                    "write the width of the line, 0 or more",
                ));
            }
            (None, Some(_), None) => {}
            (None, Some(_), Some(_)) => {
                return Err(Complaint::about("width_m", "remove it: a polygon has its own width"));
            }
            _ => {
                let remedy = "write exactly one of points_m and polygon_m";
                return Err(Complaint::about("name", remedy).finding("found none or both"));
            }
        }
        optional("occupancy", self.occupancy, Allowed::Share, "")?;
        optional("vulnerability", self.vulnerability, Allowed::Share, "")?;
        optional("persons", self.persons, Allowed::Positive, "")?;
        if let Some(vehicles) = &self.vehicles {
            vehicles.check().map_err(|wrong| wrong.inside("vehicles"))?;
        }
        self.check_exposure()
    }

    fn check_exposure(&self) -> Checked {
        let asks = [("occupancy", self.occupancy.is_some()), ("persons", self.persons.is_some())];
        if let (Some((key, _)), None) = (asks.iter().find(|(_, given)| *given), self.vulnerability)
        {
            let remedy = "write the probability that a person who is hit dies, 0..1, or remove what needs it";
            let found = format!("found {key} without it");
            return Err(Complaint::missing("vulnerability", remedy).finding(found));
        }
        match &self.vehicles {
            Some(_) if self.polygon_m.is_some() => {
                Err(Complaint::about("vehicles", "write them with points_m: they go along a line"))
            }
            Some(_) if self.occupancy.is_some() => Err(Complaint::about(
                "occupancy",
                "remove it: traffic says how often somebody is there; a person's own is own_per_day",
            )),
            Some(vehicles) if vehicles.own_per_day.is_some() && self.vulnerability.is_none() => {
                let remedy = "write the probability that a person who is hit dies, 0..1";
                Err(Complaint::missing("vulnerability", remedy))
            }
            None if self.persons.is_some() && self.occupancy.is_none() => {
                let remedy = "write the share of the time that each person is there, 0..1";
                Err(Complaint::missing("occupancy", remedy))
            }
            _ => Ok(()),
        }
    }
}

impl VehiclesTable {
    fn check(&self) -> Checked {
        number("per_day", self.per_day, Allowed::Positive, "")?;
        number("speed_km_h", self.speed_km_h, Allowed::Positive, "")?;
        number("length_m", self.length_m, Allowed::Positive, "a car is near 4.5")?;
        optional("own_per_day", self.own_per_day, Allowed::Positive, "")?;
        if self.own_per_day.is_some_and(|own| own > self.per_day) {
            let remedy = format!(
                "write at most {}, as per_day counts them too: passages a day of one person",
                self.per_day
            );
            return Err(Complaint::about("own_per_day", remedy));
        }
        // so many stand bumper to bumper along the road that passes in a day
        let most = METRES_A_DAY_OF_A_KM_H * self.speed_km_h / self.length_m;
        if self.per_day > most {
            let remedy = format!(
                "write at most {most:.0}: vehicles of {} m at {} km/h would be nearer than their own length; is it of a year?",
                self.length_m, self.speed_km_h
            );
            return Err(Complaint::about("per_day", remedy));
        }
        Ok(())
    }
}
