//! How the page looks.

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
  .dense th, .dense td { padding: 1.5px 5px 1.5px 0; }
  .dense small { line-height: 1.2; }
  .dense tbody th { min-width: 24mm; }
  .dense small { font-size: 6.8pt; }
  figure, tr, .warnings, .note, dt, dd { break-inside: avoid; }
  dt { break-after: avoid; }
  .wide { overflow: visible; }
  figure { margin: 3mm 0 5mm; }
  figure svg { max-height: 205mm; }
  .map svg { max-height: 116mm; }
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
