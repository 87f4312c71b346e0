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
];
