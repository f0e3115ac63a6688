#pragma once

namespace groundloop::bench {

/// Style sheet of report.html: follows the reader's light or dark theme, one column on a phone, plain on
/// paper.
inline constexpr const char* kReportStyle = R"css(
:root{color-scheme:light dark;--ground:#f4f6f9;--card:#fff;--ink:#18212c;--soft:#5a6675;--edge:#dde3ea;--accent:#1f5fd0;
--good:#0f7b4b;--good-ground:#e3f5ec;--bad:#b3243a;--bad-ground:#fbe7ea;--odd:#8a5a00;--odd-ground:#fdf1d8;--band:#f3a6b080;--pale:#bccbf0;
--s1:#4269d0;--s2:#e8963a;--s3:#d6455d;--s4:#3fa7a0;--s5:#6a9f3c;--s6:#b07aa1;--s7:#8c6d4f;--s8:#7f8a99;--s9:#c9b037}
@media (prefers-color-scheme:dark){:root{--ground:#10151c;--card:#19212b;--ink:#e6ebf1;--soft:#9aa7b6;--edge:#2c3744;
--accent:#7fb0ff;--good:#5fd7a0;--good-ground:#12352a;--bad:#ff8b9b;--bad-ground:#43202a;--odd:#f5c469;
--odd-ground:#3d3115;--band:#c2405780;--pale:#33466f;--s1:#7c9bf2;--s2:#f2ad5c;--s3:#f2788c;--s4:#63c7c0;--s5:#97c766;--s6:#cf9fc4;
--s7:#b8987a;--s8:#a3adba;--s9:#e3cf65}}
*{box-sizing:border-box}
body{margin:0;background:var(--ground);color:var(--ink);font:16px/1.55 system-ui,-apple-system,"Segoe UI",Roboto,
"DejaVu Sans",sans-serif}
main,header{max-width:1240px;margin:0 auto;padding:0 20px}
header{padding-top:36px}
h1{font-size:2rem;line-height:1.2;margin:0 0 4px;letter-spacing:-.01em}
h2{font-size:1.3rem;margin:48px 0 14px;letter-spacing:-.005em}
.kicker{margin:0;color:var(--soft);font-size:.85rem;text-transform:uppercase;letter-spacing:.08em}
.summary{margin:6px 0 22px;color:var(--soft);max-width:75ch}
.verdict{border-radius:12px;padding:16px 20px;border-left:6px solid}
.verdict strong{font-size:1.15rem}
.verdict ul{margin:8px 0 0;padding-left:20px}
.verdict.pass{background:var(--good-ground);border-color:var(--good)}.verdict.pass strong{color:var(--good)}
.verdict.short{background:var(--bad-ground);border-color:var(--bad)}.verdict.short strong{color:var(--bad)}
.verdict.error{background:var(--odd-ground);border-color:var(--odd)}.verdict.error strong{color:var(--odd)}
.tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(116px,1fr));gap:12px;margin:18px 0 0;padding:0}
.tiles div{background:var(--card);border:1px solid var(--edge);border-radius:12px;padding:12px 14px}
.tiles dt{color:var(--soft);font-size:.82rem;line-height:1.3}
.tiles dd{margin:2px 0 0;font-size:1.2rem;font-weight:650;font-variant-numeric:tabular-nums;white-space:nowrap}
figure{margin:0 0 20px;background:var(--card);border:1px solid var(--edge);border-radius:12px;overflow:hidden}
figure img{display:block;width:100%;height:auto;background:#fff}
figcaption{padding:12px 16px;font-size:.92rem;color:var(--soft)}
figcaption b{color:var(--ink)}
.pair{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,480px),1fr));gap:20px;align-items:start}
.scroll{overflow-x:auto;padding:12px 12px 0}
.plot{display:block;width:100%;min-width:640px;height:auto}
.svg-text{fill:var(--soft);font:12px system-ui,-apple-system,"Segoe UI",Roboto,"DejaVu Sans",sans-serif}
.svg-grid{stroke:var(--edge)}.svg-axis{stroke:var(--soft)}
.tables{columns:2 480px;column-gap:20px;margin-bottom:20px}
.card{background:var(--card);border:1px solid var(--edge);border-radius:12px;padding:6px 16px 10px;margin:0 0 20px;
break-inside:avoid;overflow-x:auto}
table{border-collapse:collapse;width:100%;font-size:.92rem}
caption{text-align:left;font-weight:650;padding:8px 0;font-size:1rem}
th,td{text-align:left;padding:6px 14px 6px 0;border-top:1px solid var(--edge);vertical-align:top;font-weight:400}
thead th{color:var(--soft);font-size:.82rem;border-top:0}
th:last-child,td:last-child{padding-right:0}
.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
td small{display:block;color:var(--soft);font-size:.8rem;line-height:1.35}
code{font:.88em ui-monospace,"SF Mono",Menlo,Consolas,"DejaVu Sans Mono",monospace;overflow-wrap:anywhere}
.provenance th{width:22ch;color:var(--soft)}
.yes{color:var(--good)}.no{color:var(--bad);font-weight:650}
.swatch{display:inline-block;width:11px;height:11px;border-radius:3px;margin-right:8px}
.note{color:var(--soft);font-style:italic}
footer{max-width:1240px;margin:40px auto 0;padding:16px 20px 40px;color:var(--soft);font-size:.85rem}
@media print{:root{color-scheme:light;--ground:#fff;--card:#fff;--ink:#000;--soft:#444;--edge:#ccc}
body{font-size:11pt}h2{margin-top:24px;break-after:avoid}figure{break-inside:avoid}.plot{min-width:0}}
)css";

}  // namespace groundloop::bench
