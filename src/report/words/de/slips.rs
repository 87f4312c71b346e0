//! What is said of numbers that look like another unit in English, in German.

/// By patterns, as for the plan.
pub(super) const SLIPS: &[(&str, &str)] = &[
    (
        "[rocks] density_kg_m3 = {a}: rock has about 2700",
        "[rocks] density_kg_m3 = {a}: Gestein hat etwa 2700",
    ),
    (
        "[rocks] radius_m reaches {r}: larger than any single rock; is it in cm or mm? write metres",
        "[rocks] radius_m reicht bis {r}: größer als jeder einzelne Block; in cm oder mm? Meter schreiben",
    ),
    (
        "volume_m3 reaches {v} m³, a radius of {r} m: larger than any single rock; is it in litres? write cubic metres",
        "volume_m3 reicht bis {v} m³, einem Radius von {r} m: größer als jeder einzelne Block; in Litern? Kubikmeter schreiben",
    ),
    (
        "[grounds.{name}] friction_angle_deg = {a} is next to no friction; is it in radians? that would be {b}",
        "[grounds.{name}] friction_angle_deg = {a} ist so gut wie keine Reibung; im Bogenmaß? das wäre {b}",
    ),
    (
        "[grounds.{name}] slip_friction.max = {a} is below the friction coefficient {b} of friction_angle_deg = {c}: friction falls with the way slipped; write {d} or more",
        "[grounds.{name}] slip_friction.max = {a} liegt unter dem Reibungsbeiwert {b} von friction_angle_deg = {c}: die Reibung fällt mit dem Gleitweg; {d} oder mehr schreiben",
    ),
    (
        "[[barriers]] \"{name}\" capacity_j = {a} takes next to nothing; is it in kJ? write {b}",
        "[[barriers]] \"{name}\" capacity_j = {a} nimmt so gut wie nichts auf; in kJ? {b} schreiben",
    ),
    (
        "[frequency] energies_j holds {a}: a thrown pebble has as much; is it in kJ? write {b}",
        "[frequency] energies_j enthält {a}: so viel hat ein geworfener Kiesel; in kJ? {b} schreiben",
    ),
    (
        "[grounds.{name}] breaks_above_j = {a} breaks every stem at a touch; is it in kJ? write {b}",
        "[grounds.{name}] breaks_above_j = {a} bricht jeden Stamm bei der ersten Berührung; in kJ? {b} schreiben",
    ),
    (
        "[rocks] density_kg_m3 = {a}: rock has about 2700; is it in t/m³? write {b}",
        "[rocks] density_kg_m3 = {a}: Gestein hat etwa 2700; in t/m³? {b} schreiben",
    ),
    (
        "epsg = {a} is no code of EPSG ({b} to {c}): rasters are written without a system",
        "epsg = {a} ist kein Code von EPSG ({b} bis {c}): Raster werden ohne Bezugssystem geschrieben",
    ),
    (
        "epsg = {a} (Web Mercator) stretches lengths by 1/cos(latitude), 1.46 at 46.8°, and leaves heights: slopes are too gentle; bring the data into the projected system of the country, as 2056 (LV95)",
        "epsg = {a} (Web Mercator) streckt Längen um 1/cos(Breite), 1.46 bei 46.8°, und lässt Höhen, wie sie sind: Hänge sind zu flach; die Daten in das projizierte System des Landes bringen, etwa 2056 (LV95)",
    ),
    (
        "epsg = {a} is a geographic system in degrees; coordinates are metres here: name the projected system of the meshes, as 2056 (LV95)",
        "epsg = {a} ist ein geographisches System in Grad; Koordinaten sind hier Meter: das projizierte System der Dreiecksnetze nennen, etwa 2056 (LV95)",
    ),
    (
        "{file}: {n} of {all} cells are exactly 0 m high and all others above {low} m: cells without data? then declare 0 as no data (gdal_translate -a_nodata 0)",
        "{file}: {n} von {all} Zellen sind genau 0 m hoch und alle anderen über {low} m: Zellen ohne Daten? dann 0 als „keine Daten“ erklären (gdal_translate -a_nodata 0)",
    ),
    (
        "[[barriers]] \"{name}\" height_m = {a} is lower than any net or dam; write metres",
        "[[barriers]] \"{name}\" height_m = {a} ist niedriger als jedes Netz und jeder Damm; Meter schreiben",
    ),
    (
        "[[barriers]] \"{name}\" design.free_height_m = {a} is more than half of any block; is it in cm? write {b}",
        "[[barriers]] \"{name}\" design.free_height_m = {a} ist mehr als die Hälfte jedes Blocks; in cm? {b} schreiben",
    ),
    (
        "[[barriers]] \"{name}\" design.elongation_m = {a} is more than any net stretches; is it in cm? write {b}",
        "[[barriers]] \"{name}\" design.elongation_m = {a} ist mehr, als sich irgendein Netz dehnt; in cm? {b} schreiben",
    ),
    (
        "gravity_m_s2 = {a}: on Earth it is 9.76 to 9.84",
        "gravity_m_s2 = {a}: auf der Erde sind es 9.76 bis 9.84",
    ),
    (
        "[release] velocity_m_s reaches {a} m/s, faster than rocks fall; is it in km/h? write {b}",
        "[release] velocity_m_s reicht bis {a} m/s, schneller als Blöcke fallen; in km/h? {b} schreiben",
    ),
    (
        "[[objects]] \"{name}\" vehicles.per_day = {a}: on one lane, with two seconds from one to the next, {b} pass; is it of a year, or of several lanes?",
        "[[objects]] \"{name}\" vehicles.per_day = {a}: auf einer Spur fahren, mit zwei Sekunden von einem zum nächsten, {b}; im Jahr, oder auf mehreren Spuren?",
    ),
];
