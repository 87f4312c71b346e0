//! What is said of numbers that look like another unit in English, in Italian.

/// By patterns, as for the plan.
pub(super) const SLIPS: &[(&str, &str)] = &[
    (
        "[rocks] density_kg_m3 = {a}: rock has about 2700",
        "[rocks] density_kg_m3 = {a}: la roccia ha circa 2700",
    ),
    (
        "[rocks] radius_m reaches {r}: larger than any single rock; is it in cm or mm? write metres",
        "[rocks] radius_m arriva a {r}: più grande di qualsiasi blocco singolo; in cm o mm? scrivere metri",
    ),
    (
        "volume_m3 reaches {v} m³, a radius of {r} m: larger than any single rock; is it in litres? write cubic metres",
        "volume_m3 arriva a {v} m³, un raggio di {r} m: più grande di ogni singolo masso; in litri? scrivere metri cubi",
    ),
    (
        "[grounds.{name}] friction_angle_deg = {a} is next to no friction; is it in radians? that would be {b}",
        "[grounds.{name}] friction_angle_deg = {a} è quasi nessun attrito; in radianti? sarebbe {b}",
    ),
    (
        "[grounds.{name}] slip_friction.max = {a} is below the friction coefficient {b} of friction_angle_deg = {c}: friction falls with the way slipped; write {d} or more",
        "[grounds.{name}] slip_friction.max = {a} è sotto il coefficiente d’attrito {b} di friction_angle_deg = {c}: l’attrito cala con la strada scivolata; scrivere {d} o più",
    ),
    (
        "[[barriers]] \"{name}\" capacity_j = {a} takes next to nothing; is it in kJ? write {b}",
        "[[barriers]] \"{name}\" capacity_j = {a} non assorbe quasi nulla; in kJ? scrivere {b}",
    ),
    (
        "[frequency] energies_j holds {a}: a thrown pebble has as much; is it in kJ? write {b}",
        "[frequency] energies_j contiene {a}: quanto un sassolino lanciato; in kJ? scrivere {b}",
    ),
    (
        "[grounds.{name}] breaks_above_j = {a} breaks every stem at a touch; is it in kJ? write {b}",
        "[grounds.{name}] breaks_above_j = {a} spezza ogni tronco al primo tocco; in kJ? scrivere {b}",
    ),
    (
        "[rocks] density_kg_m3 = {a}: rock has about 2700; is it in t/m³? write {b}",
        "[rocks] density_kg_m3 = {a}: la roccia ha circa 2700; in t/m³? scrivere {b}",
    ),
    (
        "epsg = {a} is no code of EPSG ({b} to {c}): rasters are written without a system",
        "epsg = {a} non è un codice EPSG (da {b} a {c}): i raster sono scritti senza sistema",
    ),
    (
        "epsg = {a} (Web Mercator) stretches lengths by 1/cos(latitude), 1.46 at 46.8°, and leaves heights: slopes are too gentle; bring the data into the projected system of the country, as 2056 (LV95)",
        "epsg = {a} (Web Mercator) allunga le lunghezze di 1/cos(latitudine), 1.46 a 46.8°, e lascia le altezze: i pendii sono troppo dolci; portare i dati nel sistema proiettato del paese, come 2056 (LV95)",
    ),
    (
        "epsg = {a} is a geographic system in degrees; coordinates are metres here: name the projected system of the meshes, as 2056 (LV95)",
        "epsg = {a} è un sistema geografico in gradi; qui le coordinate sono metri: indicare il sistema proiettato delle maglie, come 2056 (LV95)",
    ),
    (
        "{file}: {n} of {all} cells are exactly 0 m high and all others above {low} m: cells without data? then declare 0 as no data (gdal_translate -a_nodata 0)",
        "{file}: {n} celle su {all} sono esattamente a 0 m e tutte le altre sopra {low} m: celle senza dati? allora dichiarare 0 come dato mancante (gdal_translate -a_nodata 0)",
    ),
    (
        "[[barriers]] \"{name}\" height_m = {a} is lower than any net or dam; write metres",
        "[[barriers]] \"{name}\" height_m = {a} è più basso di ogni rete o rilevato; scrivere metri",
    ),
    (
        "[[barriers]] \"{name}\" design.free_height_m = {a} is more than half of any block; is it in cm? write {b}",
        "[[barriers]] \"{name}\" design.free_height_m = {a} è più della metà di ogni blocco; in cm? scrivere {b}",
    ),
    (
        "[[barriers]] \"{name}\" design.elongation_m = {a} is more than any net stretches; is it in cm? write {b}",
        "[[barriers]] \"{name}\" design.elongation_m = {a} è più di quanto si allunghi qualsiasi rete; in cm? scrivere {b}",
    ),
    (
        "gravity_m_s2 = {a}: on Earth it is 9.76 to 9.84",
        "gravity_m_s2 = {a}: sulla Terra va da 9.76 a 9.84",
    ),
    (
        "[release] velocity_m_s reaches {a} m/s, faster than rocks fall; is it in km/h? write {b}",
        "[release] velocity_m_s arriva a {a} m/s, più veloce di quanto cadano i massi; in km/h? scrivere {b}",
    ),
    (
        "[[objects]] \"{name}\" vehicles.per_day = {a}: on one lane, with two seconds from one to the next, {b} pass; is it of a year, or of several lanes?",
        "[[objects]] \"{name}\" vehicles.per_day = {a}: su una corsia, a due secondi l’uno dall’altro, ne passano {b}; all’anno, o su più corsie?",
    ),
];
