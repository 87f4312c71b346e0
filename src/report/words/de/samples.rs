//! What is said of samples of rocks and of lines in English, in German.

/// By patterns, as for the plan.
pub(super) const SAMPLES: &[(&str, &str)] = &[
    (
        "rocks of one world meet each other, but all intervals take them for independent and are too narrow for what they share, as how long a heap moves: run several seeds and compare",
        "Blöcke einer gemeinsamen Welt begegnen einander: alle Intervalle nehmen sie als unabhängig und sind zu eng für das, was sie teilen, etwa wie lange sich ein Haufen bewegt; mehrere Startwerte (seed) rechnen und vergleichen",
    ),
    (
        "rocks differ up to {a} times in mass and contacts up to {b} times in stiffness: where the product is more than {c} blows through several contacts are taken one by one, and a boulder on a light stone comes off too slowly; write stiffnesses that are nearer to each other, or scheme = \"adaptive\"",
        "Blöcke unterscheiden sich bis zu {a}-fach in der Masse und Kontakte bis zu {b}-fach in der Steifigkeit: wo das Produkt größer als {c} ist, werden Stöße durch mehrere Kontakte einzeln genommen, und ein großer Block auf einem leichten Stein prallt zu langsam ab; Steifigkeiten schreiben, die näher beieinander liegen, oder scheme = \"adaptive\"",
    ),
    (
        "line “{name}”: its pieces from corner {a} and corner {b} cross; a rock counts once, where it crosses first. Write the corners in order if the line is not meant so",
        "Linie „{name}“: ihre Stücke ab Ecke {a} und ab Ecke {b} kreuzen sich; ein Block zählt einmal, wo er sie zuerst quert. Die Ecken der Reihe nach schreiben, falls die Linie nicht so gemeint ist",
    ),
    (
        "line “{name}”: {a} of its {b} m have no ground below; what comes there is not computed, and its numbers hold for the rest",
        "Linie „{name}“: unter {a} ihrer {b} m liegt kein Gelände; was dort ankommt, wird nicht gerechnet, ihre Zahlen gelten für den Rest",
    ),
    (
        "{file}: cells that stand more than {m} m above or below all around them: {n}, the first at ({x}, {y}); errors of measurement, or trees and masts? rocks meet them as ground",
        "{file}: Zellen, die mehr als {m} m über oder unter allen um sie liegen: {n}, die erste bei ({x}, {y}); Messfehler, oder Bäume und Masten? Blöcke treffen sie als Boden",
    ),
    (
        "[[objects]] without [frequency]: how many releases hit them is computed, how often a year and at what risk is not",
        "[[objects]] ohne [frequency]: wie viele Ablösungen sie treffen, wird gerechnet, wie oft im Jahr und mit welchem Risiko nicht",
    ),
    (
        "{a} {kind_a} of memory, and about {b} {kind_b} of disk ({files}): {n} release, up to {p} points of paths, {c} cells of maps",
        "{a} {kind_a} Speicher, und etwa {b} {kind_b} Platte ({files}): {n} Ablösung, bis {p} Bahnpunkte, {c} Kartenzellen",
    ),
    ("kept for {k} of {n} release, every {t} s", "behalten für {k} von {n} Ablösung, alle {t} s"),
    ("from one point", "von einem Punkt"),
    ("{a} m long, {b} m wide", "{a} m lang, {b} m breit"),
    ("{name}: {a} a year of {b} m³, {rest}", "{name}: {a} pro Jahr von {b} m³, {rest}"),
    ("{name}: {a} a year of {b} m³", "{name}: {a} pro Jahr von {b} m³"),
    ("{a} a year of {b} m³, {rest}", "{a} pro Jahr von {b} m³, {rest}"),
    ("{a} a year of {b} m³", "{a} pro Jahr von {b} m³"),
    (
        "A name in quotation marks alone stands for the rocks that the barriers of each run have let through to that place: at a barrier those that arrive at it. Those that pass it are a share of all releases.",
        "Ein Name in Anführungszeichen allein steht für die Blöcke, die die Schutzbauwerke jeder Rechnung bis dorthin durchgelassen haben: bei einem Schutzbauwerk die, die dort ankommen. Die es passieren, sind ein Anteil aller Ablösungen.",
    ),
    (
        "islands of rocks that may touch, each with its own step; heaps of more than {n} that touch go on as with rigid where none is struck hard: what a spring does within a blow is left out there",
        "Inseln von Blöcken, die sich berühren können, jede mit eigenem Schritt; Haufen von mehr als {n}, die sich berühren, gehen weiter wie mit rigid, solange keiner hart getroffen wird: was eine Feder während eines Stoßes tut, ist dort weggelassen",
    ),
    (
        "{n} of {tried} releases tried out lie on the line “{name}” before they move: they do not cross it by that, and count only where they come back over it. Draw the line or the release elsewhere",
        "{n} von {tried} versuchten Ablösungen liegen schon vor der Bewegung auf der Linie „{name}“: Sie queren sie dadurch nicht und zählen nur, wo sie über sie zurückkommen. Linie oder Ablösung anderswo zeichnen",
    ),
    ("left open", "bleibt offen"),
    (
        "TEK17 § 7-3: more often than the safety classes S3 (1), S2 (2), S1 (3) permit",
        "TEK17 § 7-3: öfter, als die Sicherheitsklassen S3 (1), S2 (2), S1 (3) zulassen",
    ),
    // Families of distributions, and units of memory, in places named after them
    ("[uniform]", "gleichverteilt"),
    ("[normal]", "normalverteilt"),
    ("[lognormal]", "lognormalverteilt"),
    ("[triangular]", "dreieckverteilt"),
    ("[listed values]", "aus einer Liste"),
    ("[fixed]", "fest"),
    ("[MB]", "MB"),
    ("[GB]", "GB"),
    (
        "Direktoratet for byggkvalitet, Byggteknisk forskrift (TEK17) § 7-3, table of the second paragraph: largest nominal annual probability S1 1/100, S2 1/1000, S3 1/5000",
        "Direktoratet for byggkvalitet, Byggteknisk forskrift (TEK17) § 7-3, Tabelle des zweiten Absatzes: größte nominelle Jahreswahrscheinlichkeit S1 1/100, S2 1/1000, S3 1/5000",
    ),
    (
        "The design energy {e} {unit} is that of the design block of {v} m³ ({m} kg without factors) at P{p} of speed, {s} m/s without factors.",
        "Die Bemessungsenergie {e} {unit} ist die des Bemessungsblocks von {v} m³ ({m} kg ohne Faktoren) bei P{p} der Geschwindigkeit, {s} m/s ohne Faktoren.",
    ),
    (
        "The design energy is P{p} of total energy with the squares of the factors on speed; the standard has that of its design block at P{q} of speed, which block_volume_m3 asks for.",
        "Die Bemessungsenergie ist P{p} der Gesamtenergie mit den Quadraten der Faktoren auf die Geschwindigkeit; die Norm nimmt die ihres Bemessungsblocks bei P{q} der Geschwindigkeit, die block_volume_m3 verlangt.",
    ),
    (
        "The capacity must be {f} times that, {e} {unit}.",
        "Die Aufnahmefähigkeit muss das {f}-Fache davon sein, {e} {unit}.",
    ),
    (
        "The standard's factor on the energy of the barrier is not applied: its value is yours, capacity_factor takes it.",
        "Der Faktor der Norm auf die Energie des Bauwerks ist nicht angewandt: sein Wert ist Sache der Planung, capacity_factor nimmt ihn auf.",
    ),
];
