//! What plan and run warn of in English, in German.

/// By patterns, as for the plan.
pub(super) const WARNINGS: &[(&str, &str)] = &[
    ("[grounds.{name}] lies under no mesh", "[grounds.{name}] liegt unter keinem Dreiecksnetz"),
    (
        "[grounds.{name}] has breaks_above_j, but no tree: only trees give way",
        "[grounds.{name}] hat breaks_above_j, aber keinen Baum: nur Bäume geben nach",
    ),
    (
        "[grounds.{name}] like {known}: its source has no rolling friction, and without any nothing stops a sphere that rolls; write rolling_friction",
        "[grounds.{name}] like {known}: seine Quelle hat keine Rollreibung, und ohne sie hält nichts eine rollende Kugel auf; rolling_friction schreiben",
    ),
    (
        "capture_speed_m_s = {a} is below half the tolerance of {b} m/s: slow rocks may flutter and never come to rest; write {c} or more",
        "capture_speed_m_s = {a} liegt unter der halben Toleranz von {b} m/s: langsame Blöcke können flattern und nie zur Ruhe kommen; {c} oder mehr schreiben",
    ),
    (
        "{where} omega * step_s = {x} for a rock of {r} m, which is thrown back within one step, the livelier the longer the step: write a step_s below {y}",
        "{where} omega * step_s = {x} für einen Block von {r} m, der in einem einzigen Schritt zurückgeworfen wird, umso lebhafter, je länger der Schritt: step_s kleiner als {y} schreiben",
    ),
    (
        "step_s = {a} lets a rock fall for {b} s at most before its budget of {c} steps is spent; write a longer step, or a longest_s below that",
        "step_s = {a} lässt einen Block höchstens {b} s fallen, bis sein Budget von {c} Schritten erschöpft ist; einen längeren Schritt schreiben, oder longest_s darunter",
    ),
    (
        "{a} % of the places drawn for {n} releases have no ground or no room for the rock (a hole, a tree, the edge of the terrain): such a place is drawn again",
        "{a} % der für {n} Ablösungen gezogenen Orte haben keinen Boden oder keinen Platz für den Block (ein Loch, ein Baum, der Rand des Geländes): ein solcher Ort wird neu gezogen",
    ),
    (
        "{a} of {n} releases tried out find no place to start from: each has a row with the stop reason not_released and counts in no statistic",
        "{a} von {n} versuchten Ablösungen finden keinen Ort zum Start: jede hat eine Zeile mit dem Endgrund not_released und zählt in keiner Statistik",
    ),
    (
        "{n} releases over {k} classes of size and source: with fewer than {few} each the intervals a year may be too narrow; write count = {c} or more",
        "{n} Ablösungen auf {k} Klassen von Größe und Quelle: mit weniger als {few} in jeder können die Intervalle pro Jahr zu eng sein; count = {c} oder mehr schreiben",
    ),
    ("no ground below", "kein Boden darunter"),
    ("in the ground or a tree", "im Boden oder in einem Baum"),
    ("1/year", "1/a"),
    (
        "{who}: the rocks of one world meet each other, but all intervals take them for independent and are too narrow for what they share: a change that is clear here may be chance. Run several seeds of each scene and compare.",
        "{who}: die Blöcke einer gemeinsamen Welt begegnen einander, aber alle Intervalle nehmen sie als unabhängig und sind zu eng für das, was sie teilen: eine Änderung, die hier signifikant ist, kann Zufall sein. Mehrere Startwerte (seed) jeder Szene rechnen und vergleichen.",
    ),
    (
        "{file} says how large the rocks of its zones are, which is not used: sizes are those of the scene; where each zone says how often too, and [frequency] has no law of its own, each has its own",
        "{file} sagt, wie groß die Blöcke seiner Zonen sind, was nicht verwendet wird: Größen sind die der Szene; wo jede Zone auch sagt, wie oft, und [frequency] kein eigenes Gesetz hat, hat jede ihre eigenen",
    ),
    (
        "in the fit on all {n} of {of} computed rocks ({share} %) had not ended, {left} had left the terrain, {moving} were still moving: mean runouts and shares are at least what is said, KS distances and intervals hold however these rocks would have ended; write {what}",
        "in der Anpassung an alle waren {n} von {of} berechneten Blöcken ({share} %) nicht am Ende, {left} hatten das Gelände verlassen, {moving} bewegten sich noch: mittlere Auslaufstrecken und Anteile sind mindestens die genannten, KS-Abstände und Intervalle gelten, wie auch immer diese Blöcke geendet hätten; in der Szene anzugeben: {what}",
    ),
    (
        "{name}: rocks that had not ended leave open which values fit best, as far as to the lower end of the range tried, {a}; write a longer longest_s or a larger terrain before a smaller from in vary",
        "{name}: Blöcke, die nicht am Ende waren, lassen offen, welche Werte am besten passen, bis zum unteren Ende des versuchten Bereichs, {a}; zuerst ein längeres longest_s oder größeres Gelände angeben, dann erst in vary ein kleineres from",
    ),
    (
        "{name}: rocks that had not ended leave open which values fit best, as far as to the upper end of the range tried, {a}; write a longer longest_s or a larger terrain before a larger to in vary",
        "{name}: Blöcke, die nicht am Ende waren, lassen offen, welche Werte am besten passen, bis zum oberen Ende des versuchten Bereichs, {a}; zuerst ein längeres longest_s oder größeres Gelände angeben, dann erst in vary ein größeres to",
    ),
    ("a larger terrain", "ein größeres Gelände"),
    ("a longer longest_s", "ein längeres longest_s"),
    ("a longer longest_s and a larger terrain", "ein längeres longest_s und ein größeres Gelände"),
    (
        "{name}: the values that fit best reach the lower end of the range tried, {a}, and better ones may lie below it; write a smaller from in vary",
        "{name}: die am besten passenden Werte reichen bis ans untere Ende des versuchten Bereichs, {a}, bessere können darunter liegen; in vary ein kleineres from schreiben",
    ),
    (
        "{name}: the values that fit best reach the upper end of the range tried, {a}, and better ones may lie above it; write a larger to in vary",
        "{name}: die am besten passenden Werte reichen bis ans obere Ende des versuchten Bereichs, {a}, bessere können darüber liegen; in vary ein größeres to schreiben",
    ),
    (
        "the values tried do not explain the measured ends: KS distance {a} of the fit on all, 5 % limit {b}; write wider ranges in vary, vary other values, or look at terrain, rocks and releases",
        "die versuchten Werte erklären die gemessenen Endpunkte nicht: KS-Abstand {a} der Anpassung an alle, 5-%-Grenze {b}; in vary weitere Bereiche schreiben, andere Werte variieren, oder Gelände, Blöcke und Ablösungen prüfen",
    ),
    (
        "{file}: {n} of {of} stems do not stand on the slope: {a} with their foot more than 0.5 m above it, {b} with their top under it, {c} beside it; rocks meet them in the wrong place or not at all. Export the file in the coordinates and heights of the terrain, or look at its scale and up",
        "{file}: {n} von {of} Stämmen stehen nicht auf dem Hang: {a} mit dem Fuß mehr als 0.5 m darüber, {b} mit der Spitze darunter, {c} daneben; Blöcke treffen sie am falschen Ort oder gar nicht. Die Datei in den Koordinaten und Höhen des Geländes ausgeben, oder scale und up prüfen",
    ),
    (
        "trees: none of {n} rocks touched one; do they stand where the rocks come?",
        "Bäume: keiner von {n} Blöcken hat einen berührt; stehen sie dort, wo die Blöcke hinkommen?",
    ),
    (
        "{file}: its map coordinates are written in steps of {a}, {b} % of the median edge {c}, and {n} of its {m} facets have no area: where they were rounded, slopes are wrong; export it with three decimals or more, or with a map origin subtracted and origin_m in the scene",
        "{file}: ihre Kartenkoordinaten sind in Schritten von {a} geschrieben, {b} % des Medians der Kantenlängen {c}, und {n} ihrer {m} Dreiecke haben keine Fläche: wo gerundet wurde, stimmen die Neigungen nicht; mit drei oder mehr Nachkommastellen ausgeben, oder mit abgezogenem Ursprung und origin_m in der Szene",
    ),
    (
        "{file}: its map coordinates are written in steps of {a}, {b} % of the median edge {c}: where they were rounded, slopes are wrong; export it with three decimals or more, or with a map origin subtracted and origin_m in the scene",
        "{file}: ihre Kartenkoordinaten sind in Schritten von {a} geschrieben, {b} % des Medians der Kantenlängen {c}: wo gerundet wurde, stimmen die Neigungen nicht; mit drei oder mehr Nachkommastellen ausgeben, oder mit abgezogenem Ursprung und origin_m in der Szene",
    ),
    (
        "{n} of {all} triangles have no area and are left out: what is left is hardly the terrain; does the file have too few digits?",
        "{n} von {all} Dreiecken haben keine Fläche und sind weggelassen: was übrig ist, ist kaum das Gelände; hat die Datei zu wenige Stellen?",
    ),
    (
        "{file}: properties that are not used: {names}; zones have {known}",
        "{file}: Eigenschaften, die nicht verwendet werden: {names}; Zonen haben {known}",
    ),
    (
        "{a} % of the places drawn for {n} releases have no ground or no room for the rock (a hole, a tree, the edge of the terrain; {b} % on ground so steep that no height is clear of it): such a place is drawn again",
        "{a} % der für {n} Ablösungen gezogenen Orte haben keinen Boden oder keinen Platz für den Block (ein Loch, ein Baum, der Rand des Geländes; {b} % auf so steilem Boden, dass keine Höhe frei von ihm ist): ein solcher Ort wird neu gezogen",
    ),
    (
        "[[barriers]] \"{name}\" height_m = {a} is higher than any net; is it in cm? write {b}",
        "[[barriers]] \"{name}\" height_m = {a} ist höher als jedes Netz; in cm? {b} schreiben",
    ),
    (
        "[[barriers]] \"{name}\" height_m = {a} is higher than any net; the tallest in use have about 10 m",
        "[[barriers]] \"{name}\" height_m = {a} ist höher als jedes Netz; die höchsten im Einsatz haben etwa 10 m",
    ),
    (
        "{file}: {n} of {of} stems are left out, as no ground lies below them, the first in line {row} at ({x}, {y}): beside the slope as it is cropped, or over a hole. Where they should stand, look at crop, at the coordinates of the list and at holes of the slope",
        "{file}: {n} von {of} Stämmen sind weggelassen, weil unter ihnen kein Boden liegt, der erste in Zeile {row} bei ({x}, {y}): neben dem zugeschnittenen Hang oder über einem Loch. Wo sie stehen sollten, crop, die Koordinaten der Liste und Löcher des Hangs prüfen",
    ),
    (
        "{file}: {n} of {of} stems are left out, as no ground lies below them, the first as feature {row} at ({x}, {y}): beside the slope as it is cropped, or over a hole. Where they should stand, look at crop, at the coordinates of the list and at holes of the slope",
        "{file}: {n} von {of} Stämmen sind weggelassen, weil unter ihnen kein Boden liegt, der erste als Objekt {row} bei ({x}, {y}): neben dem zugeschnittenen Hang oder über einem Loch. Wo sie stehen sollten, crop, die Koordinaten der Liste und Löcher des Hangs prüfen",
    ),
    (
        "{n} of {m} releases tried out start more than 100 m above the ground, up to {h} m: do the heights of the releases and of the slope belong together, with their sign?",
        "{n} von {m} versuchten Ablösungen beginnen mehr als 100 m über dem Boden, bis zu {h} m: gehören die Höhen der Ablösungen und des Hangs zusammen, mit ihrem Vorzeichen?",
    ),
    (
        "none of {n} rocks touched the ground: do the places and heights of the releases belong to this slope?",
        "keiner von {n} Blöcken hat den Boden berührt: gehören Orte und Höhen der Ablösungen zu diesem Hang?",
    ),
    ("{line}: 0 of {n} rocks of {class}", "{line}: 0 von {n} Blöcken von {class}"),
    (
        "holes in the slope: {n}, the largest of {a} m² near ({x}, {y}); rocks that come there leave the terrain: fill them",
        "Löcher im Hang: {n}, das größte von {a} m² bei ({x}, {y}); Blöcke, die dorthin kommen, verlassen das Gelände: füllen",
    ),
    (
        "single corners far above or below all around them: {n}, the farthest by {a} m at ({x}, {y}); errors of measurement, or trees and masts? rocks meet them as ground",
        "einzelne Ecken weit über oder unter allen um sie: {n}, die fernste um {a} m bei ({x}, {y}); Messfehler, oder Bäume und Masten? Blöcke treffen sie als Boden",
    ),
    (
        "sheets that hang above another part of the slope: {n}, the largest of {a} m², {b} m above it near ({x}, {y}); rocks meet them as ground: leave them out if they are none",
        "Flächen, die über einem anderen Teil des Hangs hängen: {n}, die größte von {a} m², {b} m darüber bei ({x}, {y}); Blöcke treffen sie als Boden: weglassen, wenn sie keiner sind",
    ),
];
