//! From hits a year to risk: who is there, and what a hit does.

use super::super::rate::EventRate;
use serde::{Deserialize, Serialize};

/// A road, a path or a house.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Object {
    /// Its name, and that of its line in `crossings.csv`.
    pub name: String,
    /// Its middle line, or its outline, in map coordinates (m).
    pub corners_m: Vec<[f64; 2]>,
    /// Width of a line (m); none of an area.
    pub width_m: Option<f64>,
    /// Share of the time that a person is there (–).
    pub occupancy: Option<f64>,
    /// Probability that who is hit dies (–).
    pub vulnerability: Option<f64>,
    /// Persons in the object, or in one vehicle (–).
    pub persons: Option<f64>,
    /// Traffic.
    pub vehicles: Option<Vehicles>,
}

/// Traffic on a road.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Vehicles {
    /// Vehicles a day (–).
    pub per_day: f64,
    /// Their speed (km/h).
    pub speed_km_h: f64,
    /// Their length (m).
    pub length_m: f64,
    /// Passages a day of the person whose individual risk is asked for (–).
    pub own_per_day: Option<f64>,
}

impl Vehicles {
    /// Share of the time (–) that a stretch of 1 m is in front of one of so many vehicles a day: `n / (24 h · v)` per metre.
    fn share_per_m(&self, per_day: f64) -> f64 {
        per_day / (24.0 * 1000.0 * self.speed_km_h)
    }
}

/// A risk that follows from hits.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Risk {
    /// Which.
    pub kind: RiskKind,
    /// Its value a year (1/year).
    pub rate: EventRate,
}

/// What is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RiskKind {
    /// Hits of the object while a given person is there.
    PersonHit,
    /// Vehicles hit, of all traffic.
    VehiclesHit,
    /// Probability a year that a given person is killed.
    Individual,
    /// Expected deaths a year, of all persons.
    Deaths,
}

impl RiskKind {
    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::PersonHit => "Hits while a person is there",
            Self::VehiclesHit => "Vehicles hit",
            Self::Individual => "Individual risk (death of one person)",
            Self::Deaths => "Expected deaths",
        }
    }
}

impl Object {
    /// Length of road that a block of diameter `d` (m) takes of the traffic: `l_v + d`, so that its rim counts as well.
    pub(super) fn blocked_m(&self, diameter_m: f64) -> f64 {
        self.vehicles.map_or(0.0, |vehicles| vehicles.length_m + diameter_m)
    }

    /// Risks from hits a year, and from the same summed over the metres of road that each blocks (m/year).
    ///
    /// `R = λ P(T:S) V` (form of AGS 2007): a person who is there a share τ of the time has `P(T:S) = τ`; of `n` vehicles a
    /// day of length `l_v` at speed `v`, `n (l_v + d)/(24 h · v)` are in the way of a block of diameter `d`.
    pub(super) fn risks(&self, hits: &EventRate, blocked: &EventRate) -> Vec<Risk> {
        let mut risks = Vec::new();
        let mut say = |kind, rate: Option<EventRate>| {
            risks.extend(rate.map(|rate| Risk { kind, rate }));
        };
        let person = match &self.vehicles {
            None => self.occupancy.map(|share| hits.times(share)),
            Some(vehicles) => {
                say(
                    RiskKind::VehiclesHit,
                    Some(blocked.times(vehicles.share_per_m(vehicles.per_day))),
                );
                vehicles.own_per_day.map(|own| blocked.times(vehicles.share_per_m(own)))
            }
        };
        say(RiskKind::PersonHit, person);
        let individual = person.zip(self.vulnerability).map(|(hit, dies)| hit.times(dies));
        say(RiskKind::Individual, individual);
        let all = match &self.vehicles {
            None => person,
            Some(vehicles) => Some(blocked.times(vehicles.share_per_m(vehicles.per_day))),
        };
        let deaths = all.zip(self.vulnerability.zip(self.persons));
        say(RiskKind::Deaths, deaths.map(|(hit, (dies, persons))| hit.times(dies * persons)));
        risks
    }
}
