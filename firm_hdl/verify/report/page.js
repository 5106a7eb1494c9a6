"use strict";
// Tables sort by a column when its heading is clicked; numbers sort by data-v.
function value(row, column) {
  const cell = row.cells[column];
  return cell.dataset.v === undefined ? cell.textContent : Number(cell.dataset.v);
}
function sort(heading) {
  const body = heading.closest("table").tBodies[0];
  const before = heading.ariaSort;
  // Names start with the first, numbers with the largest; the next click turns that round.
  const up = before ? before === "descending" : !heading.classList.contains("n");
  for (const other of heading.parentNode.cells) other.removeAttribute("aria-sort");
  heading.ariaSort = up ? "ascending" : "descending";
  const rows = Array.from(body.rows);
  const column = heading.cellIndex;
  rows.sort((a, b) => {
    const x = value(a, column), y = value(b, column);
    const order = typeof x === "number" ? x - y : x.localeCompare(y);
    return up ? order : -order;
  });
  body.append(...rows);
}
for (const heading of document.querySelectorAll("th[data-sort]")) {
  heading.tabIndex = 0;
  heading.addEventListener("click", () => sort(heading));
  heading.addEventListener("keydown", (event) => { if (event.key === "Enter") sort(heading); });
}
for (const input of document.querySelectorAll("input[data-table]")) {
  const rows = document.getElementById(input.dataset.table).tBodies[0].rows;
  input.addEventListener("input", () => {
    const words = input.value.toLowerCase().split(/\s+/);
    for (const row of rows) {
      const text = row.textContent.toLowerCase();
      row.hidden = !words.every((word) => text.includes(word));
    }
  });
}
