"""The look of a page: on a phone, on a desk, in the dark and on paper.

Figures are drawn on white, so that in the dark they stand on a light card. Text has a contrast of
at least 4.5 to its background in both looks.
"""

STYLE = """
:root { color-scheme: light dark; --text: #1f2937; --soft: #4b5563; --back: #ffffff;
  --line: #e5e7eb; --edge: #9ca3af; --box: #f3f4f6; --link: #1d4ed8; --mark: #ffedd5;
  --good: #dcfce7; --fair: #fef3c7; --unfit: #fee2e2; }
@media (prefers-color-scheme: dark) {
  :root { --text: #e5e7eb; --soft: #b6bdc9; --back: #111827; --line: #374151; --edge: #6b7280;
    --box: #1f2937; --link: #93c5fd; --mark: #55300f; --good: #14361f; --fair: #42300a;
    --unfit: #4a1818; }
}
body { margin: 0 auto; padding: 1.5rem 1.25rem 4rem; max-width: 62rem; color: var(--text);
  background: var(--back); overflow-wrap: break-word;
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", sans-serif; }
h1 { font-size: 1.65rem; line-height: 1.25; margin: 0.5rem 0 0.25rem; }
h2 { font-size: 1.2rem; margin: 2.2rem 0 0.5rem; padding-top: 0.8rem;
  border-top: 1px solid var(--line); }
p, ul { margin: 0.5rem 0; max-width: 46rem; }
h1, p, li, figcaption { overflow-wrap: anywhere; }
a { color: var(--link); }
nav { margin: 1.2rem 0; padding: 0.5rem 0.9rem; background: var(--box); border-radius: 4px; }
nav ul { display: flex; flex-wrap: wrap; gap: 0.1rem 1.4rem; margin: 0; padding: 0;
  max-width: none; list-style: none; }
nav a { display: inline-block; padding: 0.2rem 0; }
.faint { color: var(--soft); font-size: 0.9rem; }
.banner { background: var(--fair); border-left: 4px solid #d97706; padding: 0.6rem 0.9rem;
  font-weight: 600; }
.verdict { border-left: 6px solid; padding: 0.6rem 0.9rem; max-width: none; }
.verdict p { margin: 0.2rem 0; max-width: none; }
.good { background: var(--good); border-color: #16a34a; }
.fair { background: var(--fair); border-color: #d97706; }
.unfit { background: var(--unfit); border-color: #dc2626; }
figure { margin: 1rem 0; }
.panels { display: grid; background: #ffffff; padding: 4px; border-radius: 6px; }
.panels p { grid-column: 1 / -1; margin: 0.3rem 0.4rem; max-width: none; color: #1f2937;
  font-size: 0.9rem; font-weight: 600; }
.panel { overflow-x: auto; min-width: 0; }
.panel img { display: block; max-width: 100%; height: auto; }
.legend { grid-column: 1 / -1; }
.legend img { margin: 0.2rem auto; }
figcaption { color: var(--soft); font-size: 0.9rem; max-width: 46rem; margin-top: 0.3rem; }
.wide, .equation { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 0.92rem;
  margin: 0.6rem 0; }
caption { text-align: left; color: var(--soft); font-size: 0.9rem; padding-bottom: 0.3rem; }
th, td { text-align: right; padding: 0.22rem 0.9rem 0.22rem 0; white-space: nowrap;
  border-bottom: 1px solid var(--line); }
th { color: var(--soft); font-weight: 600; border-bottom: 1px solid var(--edge); }
th:first-child, td:first-child { text-align: left; }
th.said, td.said { white-space: normal; text-align: left; min-width: 15rem; }
tr.marked td { background: var(--mark); font-weight: 600; }
pre, code { font: 0.88rem/1.5 ui-monospace, "Cascadia Mono", Menlo, Consolas, monospace; }
pre { background: var(--box); padding: 0.7rem 0.9rem; overflow-x: auto; border-radius: 4px; }
.equation { font: italic 1.08rem/1.8 Georgia, "Times New Roman", serif;
  margin: 0.6rem 0 0.6rem 1.2rem; }
@media (max-width: 40rem) {
  body { padding: 0.8rem 0.6rem 3rem; }
  .equation { margin-left: 0; }
}
@media print {
  :root { color-scheme: light; --text: #000000; --soft: #374151; --back: #ffffff; --line: #d1d5db;
    --edge: #6b7280; --box: #f3f4f6; --link: #000000; --mark: #ffedd5; --good: #dcfce7;
    --fair: #fef3c7; --unfit: #fee2e2; }
  @page { margin: 15mm; }
  body { padding: 0; max-width: none; font-size: 10.5pt; print-color-adjust: exact;
    -webkit-print-color-adjust: exact; }
  nav { display: none; }
  h1, h2, caption { break-after: avoid; }
  tr, .panel, .verdict, pre { break-inside: avoid; }
  figcaption { break-before: avoid; }
  .wide, .panel, .equation, pre { overflow: visible; }
  .panels { padding: 0;
    grid-template-columns: repeat(auto-fit, minmax(16rem, 1fr)) !important; }
  .panels .panel img { min-width: 0; }
  table { font-size: 8.5pt; }
  th, td { white-space: normal; overflow-wrap: anywhere; padding-right: 0.5rem; }
  th.said, td.said { min-width: 0; }
  pre { white-space: pre-wrap; overflow-wrap: anywhere; }
}
"""
