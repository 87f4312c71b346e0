//! What is said of samples of rocks in English, in Italian.

/// By patterns, as for the plan.
pub(super) const SAMPLES: &[(&str, &str)] = &[(
    "rocks of one world meet each other, but all intervals take them for independent and are too narrow for what they share, as how long a heap moves: run several seeds and compare",
    "i blocchi di uno stesso mondo si incontrano: tutti gli intervalli li considerano indipendenti e sono troppo stretti per ciò che hanno in comune, come la durata del moto di un cumulo; calcolare con più semi (seed) e confrontare",
)];
