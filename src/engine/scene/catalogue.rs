//! Ground values from literature, by name, each with its source.
//!
//! Only values that were read in their source stand here. None of the tables knows contact springs or the friction
//! angle of this law: a scene writes those itself.

use std::fmt::Write as _;

/// A ground of the catalogue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownGround {
    /// Name for `like`.
    pub name: &'static str,
    /// What it is.
    pub what: &'static str,
    /// Normal restitution (–): range, drawn uniformly once per release.
    pub restitution: [f64; 2],
    /// Rolling friction (–): range, drawn uniformly once per release; none if the source has none.
    pub rolling_friction: Option<[f64; 2]>,
    /// Where it was read.
    pub source: &'static str,
}

const STONE: &str = "r.stone manual (GRASS GIS), after Guzzetti et al. 2002 and Alvioli et al. 2021; each value ±10 %";
const CRSP: &str =
    "CRSP 3 values of a site study, Colorado Division of Reclamation, Mining and Safety";

/// A class of r.stone: mean friction and restitution, both drawn within ±10 %.
const fn stone(
    name: &'static str,
    what: &'static str,
    friction: f64,
    restitution: f64,
) -> KnownGround {
    KnownGround {
        name,
        what,
        restitution: [0.9 * restitution, 1.1 * restitution],
        rolling_friction: Some([0.9 * friction, 1.1 * friction]),
        source: STONE,
    }
}

const fn crsp(name: &'static str, what: &'static str, restitution: [f64; 2]) -> KnownGround {
    KnownGround { name, what, restitution, rolling_friction: None, source: CRSP }
}

/// All of them.
pub const CATALOGUE: [KnownGround; 10] = [
    stone(
        "rstone/hard-rock",
        "carbonate, lava, intrusive and non-schistose metamorphic rock",
        0.30,
        0.65,
    ),
    stone("rstone/marl-schist", "carbonate and marl sequences, schists", 0.35, 0.60),
    stone(
        "rstone/consolidated-clastic",
        "consolidated clastic rock, marl, flysch, pyroclastic rock",
        0.40,
        0.55,
    ),
    stone("rstone/loose-clastic", "loose clastic rock, mélange, evaporites", 0.35, 0.45),
    stone("rstone/debris", "anthropic, coastal, landslide and glacial deposits", 0.65, 0.35),
    stone("rstone/alluvial", "alluvial, lacustrine and colluvial deposits", 0.80, 0.15),
    stone("rstone/lake-glacier", "lakes and glaciers", 0.95, 0.10),
    crsp("crsp/sandstone", "sandstone cliff and pavement", [0.33, 0.37]),
    crsp("crsp/talus", "talus, upper slope", [0.30, 0.33]),
    crsp("crsp/colluvium", "colluvium, lower slope", [0.28, 0.30]),
];

/// The ground of that name.
pub fn known_ground(name: &str) -> Option<&'static KnownGround> {
    CATALOGUE.iter().find(|ground| ground.name == name)
}

impl KnownGround {
    /// Its values in words.
    pub fn values(&self) -> String {
        let range = |[low, high]: [f64; 2]| format!("{low:.3} to {high:.3}");
        let rolling = match self.rolling_friction {
            Some(rolling) => format!(", rolling friction {}", range(rolling)),
            None => String::new(),
        };
        format!("restitution {}{rolling}", range(self.restitution))
    }
}

/// The whole catalogue as a list to read.
pub fn catalogue() -> String {
    let mut text = String::from(
        "Grounds for `like = \"NAME\"` under [grounds.…]. Own values beside it override; springs and friction angle are\n\
         always the scene's own. The tangential restitution of the sources is another law's and has no place in this one, where\n\
         friction takes what slips and tangential_ratio says what an impact that sticks gives back. CRSP lets restitution fall with\n\
         speed (Pfeiffer and Bowen 1989): restitution_half_speed_m_s does so here; its constant was not read in a source and is yours.\n",
    );
    for ground in &CATALOGUE {
        let KnownGround { name, what, source, .. } = ground;
        let values = ground.values();
        // writing to a string cannot fail
        let _ = write!(
            text,
            "\n{name}\n    {what}\n    {values}\n    tangential ratio: none known\n    source: {source}\n"
        );
    }
    text
}
