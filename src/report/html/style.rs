//! How the page looks.

/// The style of the page, for screen and A4.
pub(super) const STYLE: &str = "\
:root { color-scheme: only light; }
* { box-sizing: border-box; }
body { margin: 0; background: #fff; color: #222; font: 15px/1.5 Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif; }
main { max-width: 900px; margin: 0 auto; padding: 28px 24px 48px; }
h1 { font-size: 27px; line-height: 1.2; margin: 0 0 4px; overflow-wrap: anywhere; }
h2 { font-size: 19px; margin: 38px 0 10px; padding-bottom: 3px; border-bottom: 1px solid #bbb; }
h3 { font-size: 15px; margin: 20px 0 4px; }
.question { font-size: 16px; margin: 8px 0 0; }
nav { margin: 26px 0 0; padding: 10px 16px; background: #f5f5f3; font-size: 14px; }
nav ol { margin: 0; padding-left: 22px; columns: 2; column-gap: 32px; }
a { color: #0072b2; text-decoration: none; }
.checks th { width: 110px; font-weight: normal; color: #555; }
.checks td:nth-child(2) { white-space: nowrap; }
p { margin: 0 0 10px; }
.subtitle { color: #555; margin: 0 0 2px; overflow-wrap: anywhere; }
.facts, .note, footer, small { color: #666; }
.facts, .note { font-size: 13px; }
.facts { margin: 0; }
.front { margin-top: 18px; display: flex; flex-direction: column; }
.front .warnings { order: 1; }
.front .map { order: 2; }
.front .answer { order: 3; }
.front .rocks { order: 4; }
.front h3 { margin-top: 16px; }
.front .answer h3:first-child { margin-top: 0; }
.warnings { margin: 0 0 16px; padding: 10px 16px; border-left: 5px solid #d55e00; background: #fdf1e8; }
.warnings h2 { margin: 0 0 4px; border: 0; font-size: 16px; }
.warnings ul { margin: 0; font-size: 14px; }
.front .warnings ul { font-size: 13px; line-height: 1.4; padding-left: 18px; }
.front .note { font-size: 12px; line-height: 1.4; }
ul { margin: 0 0 10px; padding-left: 22px; }
li, td, th, dd, figcaption { overflow-wrap: anywhere; }
table { border-collapse: collapse; width: 100%; font-size: 14px; }
th, td { text-align: left; vertical-align: top; padding: 4px 12px 4px 0; border-bottom: 1px solid #e2e2e2; }
thead th { border-bottom: 1.5px solid #555; }
tbody th { font-weight: normal; }
.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.headline { font-size: 13px; margin-top: 8px; }
.headline th, .headline td { padding: 3px 10px 3px 0; }
.headline tr > :last-child { white-space: nowrap; padding-right: 0; }
.pairs th { width: 34%; font-weight: normal; color: #555; }
.wide { overflow-x: auto; }
.dense { font-size: 12.5px; }
.dense th, .dense td { padding-right: 8px; }
.dense thead th { white-space: normal; overflow-wrap: normal; vertical-align: bottom; }
.dense tbody th { min-width: 120px; }
small { font-size: 11px; }
.lacking, .verdict { white-space: normal; overflow-wrap: normal; }
figure { margin: 20px 0 28px; }
figure svg { display: block; max-width: 100%; height: auto; margin: 0 auto; }
figcaption { max-width: 680px; margin: 8px auto 0; font-size: 13px; line-height: 1.45; color: #333; }
.map { margin: 0 0 16px; }
pre { margin: 0; padding: 10px 12px; background: #f5f5f3; font: 12.5px/1.5 'Liberation Mono', Menlo, Consolas, monospace; white-space: pre-wrap; overflow-wrap: anywhere; }
dt { font-weight: bold; margin-top: 8px; }
dd { margin: 0 0 4px 0; }
footer { margin-top: 40px; padding-top: 8px; border-top: 1px solid #bbb; font-size: 12px; overflow-wrap: anywhere; }
@media screen and (max-width: 640px) {
  main { padding: 16px 12px 32px; }
  figure { overflow-x: auto; }
  figure svg { max-width: none; min-width: 560px; }
  nav ol { columns: 1; }
}
@media screen and (min-width: 1240px) {
  .front, .site { margin-left: -150px; margin-right: -150px; }
  .front { display: flow-root; }
  .front .map, .front .rocks { float: left; clear: left; width: 500px; }
  .front .warnings, .front .answer { margin-left: 532px; }
  .front .map svg { width: 100%; max-height: 600px; }
}
@page { size: A4; margin: 13mm 15mm 16mm; @bottom-right { content: counter(page) ' / ' counter(pages); font: 8pt Helvetica, Arial, sans-serif; color: #666; } }
@media print {
  body { font-size: 9.5pt; line-height: 1.4; }
  main { max-width: none; padding: 0; }
  h1 { font-size: 17pt; }
  h2, h3, thead { break-after: avoid; }
  h2 { margin-top: 6mm; font-size: 13pt; }
  h3 { font-size: 10.5pt; margin-top: 4mm; }
  .facts, .note { font-size: 8pt; line-height: 1.3; }
  .note { break-before: avoid; margin: 1mm 0 2mm; }
  .question { font-size: 10pt; margin-top: 1.5mm; }
  .front { margin-top: 3mm; display: grid; grid-template-columns: 102mm minmax(0, 1fr); column-gap: 5mm; grid-template-rows: auto 1fr; grid-template-areas: 'map warn' 'map rocks' 'answer answer'; }
  .front:has(.warnings li:nth-child(4)) { grid-template-rows: auto auto; grid-template-areas: 'warn warn' 'map rocks' 'answer answer'; }
  .front .warnings { grid-area: warn; margin: 0 0 2mm; padding: 1.5mm 2.5mm; }
  .front .warnings h2 { font-size: 10pt; }
  .front .warnings ul { font-size: 7.5pt; line-height: 1.3; padding-left: 3.5mm; }
  .front .map { grid-area: map; margin: 0; }
  .front .map svg { width: 100%; max-height: 118mm; }
  .front .map figcaption { font-size: 7.5pt; margin-top: 1mm; line-height: 1.3; }
  .front .answer { grid-area: answer; }
  .front .rocks { grid-area: rocks; }
  .front .note { font-size: 7pt; margin: 0.6mm 0 0; }
  .front h3, .front .answer h3:first-child { margin: 2.5mm 0 0; font-size: 9.5pt; }
  .headline { font-size: 8pt; margin: 0; }
  .headline th, .headline td { padding: 0.7mm 1.5mm 0.7mm 0; }
  nav { margin-top: 5mm; padding: 2mm 4mm; font-size: 9pt; break-inside: avoid; print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  table { font-size: 9pt; }
  th, td { padding: 0.8mm 3mm 0.8mm 0; }
  .dense { font-size: 8pt; break-inside: avoid; }
  .long { break-inside: auto; }
  .long tbody tr:nth-child(-n+3) { break-after: avoid; }
  .long tbody tr:nth-last-child(-n+3) { break-before: avoid; }
  .dense th, .dense td { padding: 1.5px 5px 1.5px 0; }
  .dense tbody th { min-width: 24mm; }
  .dense small { font-size: 6.8pt; line-height: 1.2; }
  figure, tr, .warnings, .note, dt, dd { break-inside: avoid; }
  dt { break-after: avoid; }
  dl { columns: 2; column-gap: 8mm; font-size: 8.5pt; }
  .wide { overflow: visible; }
  figure { margin: 3mm 0 4mm; }
  figure svg { max-height: 150mm; }
  .sheet svg { max-height: 205mm; }
  figcaption { font-size: 8pt; line-height: 1.35; margin-top: 1mm; max-width: none; }
  footer { margin-top: 4mm; break-before: avoid; }
  pre { font-size: 7.8pt; }
  pre, .warnings { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
";

#[cfg(test)]
mod tests {
    use super::STYLE;

    /// Many warnings beside the map made one row that no page could break: it went to the second page, and the first held the title alone.
    /// From the fourth on they stand above the map, over the whole width.
    #[test]
    fn many_warnings_stand_above_the_map_on_paper() {
        let print = STYLE.split("@media print").nth(1).unwrap_or_default();
        let many = print.find(".front:has(.warnings li:nth-child(4))");
        let areas = many.and_then(|at| print[at..].split('}').next());
        assert!(areas.is_some_and(|rule| rule.contains("'warn warn' 'map rocks'")), "{areas:?}");
    }
}
