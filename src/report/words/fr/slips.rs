//! What is said of numbers that look like another unit in English, in French.

/// By patterns, as for the plan.
pub(super) const SLIPS: &[(&str, &str)] = &[
    (
        "[rocks] density_kg_m3 = {a}: rock has about 2700",
        "[rocks] density_kg_m3 = {a}\u{a0}: la roche a environ 2700",
    ),
    (
        "[rocks] radius_m reaches {r}: larger than any single rock; is it in cm or mm? write metres",
        "[rocks] radius_m va jusqu’à {r}\u{a0}: plus grand que tout bloc isolé\u{a0}; en cm ou mm\u{a0}? écrire des mètres",
    ),
    (
        "volume_m3 reaches {v} m³, a radius of {r} m: larger than any single rock; is it in litres? write cubic metres",
        "volume_m3 va jusqu’à {v} m³, un rayon de {r} m\u{a0}: plus grand que tout bloc isolé\u{a0}; en litres\u{a0}? écrire des mètres cubes",
    ),
    (
        "[grounds.{name}] friction_angle_deg = {a} is next to no friction; is it in radians? that would be {b}",
        "[grounds.{name}] friction_angle_deg = {a} n’est presque aucun frottement\u{a0}; en radians\u{a0}? ce serait {b}",
    ),
    (
        "[grounds.{name}] slip_friction.max = {a} is below the friction coefficient {b} of friction_angle_deg = {c}: friction falls with the way slipped; write {d} or more",
        "[grounds.{name}] slip_friction.max = {a} est au-dessous du coefficient de frottement {b} de friction_angle_deg = {c}\u{a0}: le frottement baisse avec le chemin glissé\u{a0}; écrire {d} ou plus",
    ),
    (
        "[[barriers]] \"{name}\" capacity_j = {a} takes next to nothing; is it in kJ? write {b}",
        "[[barriers]] \"{name}\" capacity_j = {a} n’absorbe presque rien\u{a0}; en kJ\u{a0}? écrire {b}",
    ),
    (
        "[frequency] energies_j holds {a}: a thrown pebble has as much; is it in kJ? write {b}",
        "[frequency] energies_j contient {a}\u{a0}: autant qu’un caillou lancé\u{a0}; en kJ\u{a0}? écrire {b}",
    ),
    (
        "[grounds.{name}] breaks_above_j = {a} breaks every stem at a touch; is it in kJ? write {b}",
        "[grounds.{name}] breaks_above_j = {a} rompt chaque tronc au premier contact\u{a0}; en kJ\u{a0}? écrire {b}",
    ),
    (
        "[rocks] density_kg_m3 = {a}: rock has about 2700; is it in t/m³? write {b}",
        "[rocks] density_kg_m3 = {a}\u{a0}: la roche a environ 2700\u{a0}; en t/m³\u{a0}? écrire {b}",
    ),
    (
        "epsg = {a} is no code of EPSG ({b} to {c}): rasters are written without a system",
        "epsg = {a} n’est pas un code EPSG ({b} à {c})\u{a0}: les rasters sont écrits sans système",
    ),
    (
        "epsg = {a} (Web Mercator) stretches lengths by 1/cos(latitude), 1.46 at 46.8°, and leaves heights: slopes are too gentle; bring the data into the projected system of the country, as 2056 (LV95)",
        "epsg = {a} (Web Mercator) allonge les longueurs de 1/cos(latitude), 1.46 à 46.8°, et laisse les hauteurs\u{a0}: les pentes sont trop douces\u{a0}; mettre les données dans le système projeté du pays, comme 2056 (LV95)",
    ),
    (
        "epsg = {a} is a geographic system in degrees; coordinates are metres here: name the projected system of the meshes, as 2056 (LV95)",
        "epsg = {a} est un système géographique en degrés\u{a0}; ici les coordonnées sont des mètres\u{a0}: nommer le système projeté des maillages, comme 2056 (LV95)",
    ),
    (
        "{file}: {n} of {all} cells are exactly 0 m high and all others above {low} m: cells without data? then declare 0 as no data (gdal_translate -a_nodata 0)",
        "{file}\u{a0}: {n} mailles sur {all} sont à 0 m exactement et toutes les autres au-dessus de {low} m\u{a0}: des mailles sans données\u{a0}? alors déclarer 0 comme absence de données (gdal_translate -a_nodata 0)",
    ),
    (
        "[[barriers]] \"{name}\" height_m = {a} is lower than any net or dam; write metres",
        "[[barriers]] \"{name}\" height_m = {a} est plus bas que tout filet ou digue\u{a0}; écrire des mètres",
    ),
    (
        "[[barriers]] \"{name}\" design.free_height_m = {a} is more than half of any block; is it in cm? write {b}",
        "[[barriers]] \"{name}\" design.free_height_m = {a} dépasse la moitié de tout bloc\u{a0}; en cm\u{a0}? écrire {b}",
    ),
    (
        "[[barriers]] \"{name}\" design.elongation_m = {a} is more than any net stretches; is it in cm? write {b}",
        "[[barriers]] \"{name}\" design.elongation_m = {a} dépasse l’allongement de tout filet\u{a0}; en cm\u{a0}? écrire {b}",
    ),
    (
        "gravity_m_s2 = {a}: on Earth it is 9.76 to 9.84",
        "gravity_m_s2 = {a}\u{a0}: sur Terre, de 9.76 à 9.84",
    ),
    (
        "[release] velocity_m_s reaches {a} m/s, faster than rocks fall; is it in km/h? write {b}",
        "[release] velocity_m_s va jusqu’à {a} m/s, plus vite que ne tombent les blocs\u{a0}; en km/h\u{a0}? écrire {b}",
    ),
    (
        "[[objects]] \"{name}\" vehicles.per_day = {a}: on one lane, with two seconds from one to the next, {b} pass; is it of a year, or of several lanes?",
        "[[objects]] \"{name}\" vehicles.per_day = {a}\u{a0}: sur une voie, à deux secondes l’un de l’autre, il en passe {b}\u{a0}; par an, ou sur plusieurs voies\u{a0}?",
    ),
];
