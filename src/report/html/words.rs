//! Words that stand in every report.

/// How the numbers came about, in four sentences; the fifth names the scheme in force.
pub(super) const METHOD: [&str; 4] = [
    "Each rock is a homogeneous sphere that falls, bounces, slides and rolls over the triangle meshes of slope and trees: flights \
     are exact parabolas, and a contact belongs to one face, edge or corner, so that seams between triangles are not felt.",
    "Contacts follow spherical discontinuous deformation analysis: springs normal and along the surface, limited by Coulomb \
     friction, with damping that gives the stated restitution and an optional rolling friction.",
    "Every rock is a function of scene, seed and its number alone: the same alone, among all others, and on any number of threads.",
    "All rocks are counted, those that failed or left the terrain too, and every estimate stands beside its confidence interval.",
];

/// What the terms mean here.
pub(super) const GLOSSARY: [(&str, &str); 24] = [
    (
        "Percentile",
        "Over rocks, of each rock's value: its largest along the way, or at its first crossing of a line. On maps: of each rock's \
         largest value in the cell. P95 is the value that 95 % of the rocks do not exceed.",
    ),
    (
        "95 % interval",
        "For percentiles from order statistics, which assumes no distribution; for shares Wilson's interval. It covers chance \
         in the sample only.",
    ),
    (
        "≥ and ≤",
        "The number is a bound: rocks that left the terrain, or were still moving when their time was up, would have gone on. Their \
         runout is at least, their reach angle at most what was seen; a percentile that they decide is a bound too and has no \
         interval on that side. The truth lies there however the rocks would have gone on.",
    ),
    (
        "With and without barriers",
        "Without: all rocks that cross the line. With: those that no barrier stops before it. A rock that a barrier lets through keeps \
         its energy.",
    ),
    ("Runout", "Horizontal distance from release to end."),
    (
        "Reach angle (Fahrböschung)",
        "atan(drop / runout), drop and runout measured from release to end.",
    ),
    (
        "Bounce height",
        "Vertical distance from the ground below to the lowest point of the rock. A barrier also needs it at right angles to the slope.",
    ),
    ("Translational energy", "m v²/2 of the centre."),
    ("Rotational energy", "I ω²/2 with I = 2/5 m R²."),
    (
        "Total energy",
        "The sum of both at one instant; its largest value is not the sum of the two largest.",
    ),
    (
        "Reach probability",
        "Crossings over releases: conditional on release. It is not a frequency; that needs the frequency of releases.",
    ),
    (
        "Stop",
        "At rest: slower than the rest speed for the rest time, in contact. Left the terrain: beyond the edge of the meshes. \
         Time up: still moving at the longest simulated time. Failed: the computation could not go on.",
    ),
    (
        "Evaluation line",
        "A vertical curtain over a line of the map. Values are those at a rock's first crossing of it, found on the parabola or the \
         step that crosses; a rock that comes back is counted, its later crossings are in no statistic.",
    ),
    (
        "Retention",
        "The share of releases that does not reach a line: what is missing between two lines has stopped there.",
    ),
    (
        "Height normal to the slope",
        "Distance from the plane of the triangle below to the rock, at right angles to that triangle: the height that a barrier \
         standing at right angles to the slope must have.",
    ),
    (
        "Barrier",
        "A line with a height and an energy capacity. It stops a rock whose highest point is not above its edge and whose total \
         energy it takes, and changes no rock's way in the computation; what it stops does not arrive at those behind it.",
    ),
    (
        "Design energy, design height",
        "A percentile over the rocks that arrive, times the partial factors that are printed one by one, and for the height plus the \
         free height. Factors on the speed enter the energy squared. P95 needs 59 rocks, P99 299: with fewer there is none. The interval \
         is that of the percentile.",
    ),
    (
        "Intensity",
        "Swiss classes of the 95th percentile of total energy of the rocks that pass a cell: weak below 30 kJ, medium 30 to 300 kJ, \
         strong above 300 kJ. The largest energy would grow with the number of releases.",
    ),
    (
        "Conditional on release, a year",
        "Conditional on release: given that a rock has been released; a share of releases or events. A year: how often it happens, \
         the sources' own frequency included. Only tables and figures that say “a year” or “return period” hold numbers of the second kind.",
    ),
    (
        "Passage frequency, energy exceedance",
        "Failure frequency (events a year at a source) times reach probability (conditional on release), summed over sources and sizes; \
         energy exceedance λ(E ≥ e) counts passages with at least the total energy e only.",
    ),
    (
        "Return period",
        "1/λ. The energy of a return period T is the one with λ(E ≥ e) = 1/T. The probability of one or more in a year is 1 − e^−λ.",
    ),
    (
        "Hit of an object",
        "Seen from above, the rim of the rock comes over the object: within (width + diameter)/2 of its line, or half a diameter of its \
         outline. At any height. Each rock counts once, with its energy at that moment.",
    ),
    (
        "Passages and deposits",
        "Rocks that have been in a cell, each counted once; rocks that came to rest in it.",
    ),
    (
        "KS distance (Kolmogorov and Smirnov)",
        "The largest difference between two cumulative distributions (0 to 1). Its 5 % limit is what two samples of these sizes from \
         one and the same distribution exceed once in twenty times.",
    ),
];

/// The style of the page, for screen and A4.
pub(super) const STYLE: &str = "\
:root { color-scheme: light; }
* { box-sizing: border-box; }
body { margin: 0; background: #fff; color: #222; font: 15px/1.5 Helvetica, Arial, 'Liberation Sans', sans-serif; }
main { max-width: 900px; margin: 0 auto; padding: 36px 24px 48px; }
h1 { font-size: 27px; line-height: 1.2; margin: 0 0 6px; overflow-wrap: anywhere; }
h2 { font-size: 19px; margin: 38px 0 10px; padding-bottom: 3px; border-bottom: 1px solid #bbb; }
h3 { font-size: 15px; margin: 20px 0 4px; }
.question { font-size: 16px; margin: 8px 0 0; }
nav { margin: 26px 0 0; padding: 10px 16px; background: #f5f5f3; font-size: 14px; }
nav ol { margin: 0; padding-left: 22px; columns: 2; column-gap: 32px; }
a { color: #0072b2; text-decoration: none; }
.checks th { width: 110px; font-weight: normal; color: #555; }
.checks td:nth-child(2) { white-space: nowrap; }
p { margin: 0 0 10px; }
.subtitle { font-size: 17px; color: #555; }
.facts, .note, footer, small { color: #666; }
.facts, .note { font-size: 13px; }
.warnings { margin: 22px 0; padding: 10px 16px; border-left: 5px solid #d55e00; background: #fdf1e8; }
.warnings h2 { margin: 0 0 4px; border: 0; font-size: 16px; }
.warnings ul { margin: 0; font-size: 14px; }
ul { margin: 0 0 10px; padding-left: 22px; }
li, td, th, dd, figcaption { overflow-wrap: anywhere; }
table { border-collapse: collapse; width: 100%; font-size: 14px; }
th, td { text-align: left; vertical-align: top; padding: 4px 12px 4px 0; border-bottom: 1px solid #e2e2e2; }
thead th { border-bottom: 1.5px solid #555; }
tbody th { font-weight: normal; }
.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.pairs th { width: 34%; font-weight: normal; color: #555; }
.wide { overflow-x: auto; }
.dense { font-size: 12.5px; }
.dense th, .dense td { padding-right: 8px; }
.dense thead th { white-space: normal; overflow-wrap: normal; vertical-align: bottom; }
.dense tbody th { min-width: 120px; }
small { font-size: 11px; }
figure { margin: 20px 0 28px; }
figure svg { display: block; width: 100%; max-width: 680px; height: auto; margin: 0 auto; }
figcaption { max-width: 680px; margin: 8px auto 0; font-size: 13px; line-height: 1.45; color: #333; }
pre { margin: 0; padding: 10px 12px; background: #f5f5f3; font: 12.5px/1.5 'Liberation Mono', Menlo, Consolas, monospace; white-space: pre-wrap; overflow-wrap: anywhere; }
dt { font-weight: bold; margin-top: 8px; }
dd { margin: 0 0 4px 0; }
footer { margin-top: 40px; padding-top: 8px; border-top: 1px solid #bbb; font-size: 12px; overflow-wrap: anywhere; }
@page { size: A4; margin: 13mm 15mm 16mm; @bottom-right { content: counter(page) ' / ' counter(pages); font: 8pt Helvetica, Arial, sans-serif; color: #666; } }
@media print {
  body { font-size: 10pt; }
  main { max-width: none; padding: 0; }
  h2, h3, thead { break-after: avoid; }
  .note { break-before: avoid; }
  h2 { margin-top: 8mm; }
  .dense { break-inside: avoid; font-size: 8pt; }
  .dense th, .dense td { padding-right: 5px; }
  .dense tbody th { min-width: 24mm; }
  .dense small { font-size: 6.8pt; }
  figure, tr, .warnings, .note, dt, dd { break-inside: avoid; }
  dt { break-after: avoid; }
  .wide { overflow: visible; }
  figure { margin: 3mm 0 5mm; }
  figure svg { max-height: 205mm; }
  .map svg { max-height: 138mm; }
  .map { margin: 2mm 0; }
  .warnings { margin: 3mm 0; padding: 2mm 4mm; }
  .warnings ul { font-size: 8.5pt; }
  .question { font-size: 10.5pt; }
  nav { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  figcaption { font-size: 8.5pt; }
  pre { font-size: 7.8pt; }
  pre, .warnings { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
";
