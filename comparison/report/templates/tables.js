"use strict";
// every table of the page: a click on a heading sorts, a button copies the table as CSV
const cellValue = cell => cell.dataset.value ?? cell.textContent.trim().replace(/\s+/g, " ");
function csvOf(table) {
  const inert = text => /^[=@]/.test(text) ? `'${text}` : text;  // no formula where a spreadsheet opens it
  const quoted = text => /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  const rows = [...table.rows].filter(row => row.cells.length);
  return rows.map(row => [...row.cells].map(cell => quoted(row.parentElement.tagName === "THEAD" ? cell.textContent.trim() : inert(cellValue(cell)))).join(",")).join("\n") + "\n";
}
async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {  // not allowed to a page from a file in some browsers: the older way is
    const field = element("textarea", "aside", text);
    document.body.append(field);
    field.select();
    document.execCommand("copy");
    field.remove();
  }
}
function sortBy(table, heading, column) {
  const down = heading.getAttribute("aria-sort") === "ascending";
  [...table.tHead.rows[0].cells].forEach(other => other.removeAttribute("aria-sort"));
  heading.setAttribute("aria-sort", down ? "descending" : "ascending");
  const key = row => row.cells[column] ? cellValue(row.cells[column]) : "";
  const order = (first, second) => {
    const a = key(first), b = key(second), x = Number(a), y = Number(b), numbers = a !== "" && b !== "" && !Number.isNaN(x) && !Number.isNaN(y);
    return numbers ? x - y : Number.isNaN(x) !== Number.isNaN(y) ? Number.isNaN(x) - Number.isNaN(y) : a.localeCompare(b);
  };
  const rows = [...table.tBodies[0].rows].sort(order);
  table.tBodies[0].append(...(down ? rows.reverse() : rows));
}
function equipTable(table) {
  [...table.tHead?.rows[0].cells ?? []].forEach((heading, column) => {
    if (table.classList.contains("fixed") || !heading.textContent.trim()) return;
    const button = element("button", "sort", ...heading.childNodes);
    button.type = "button";
    button.addEventListener("click", () => sortBy(table, heading, column));
    heading.replaceChildren(button);
  });
  const copy = element("button", "copy", "copy as CSV"), answer = element("span", "soft");
  copy.type = "button";
  answer.setAttribute("role", "status");
  copy.addEventListener("click", async () => {
    await copyText(csvOf(table));
    answer.textContent = `${[...table.tBodies].flatMap(body => [...body.rows]).length} rows copied`;
  });
  const frame = table.closest(".table") ?? table;
  frame.after(element("p", "tools", copy, " ", answer));
  if (frame !== table) scrollable(frame, table);
}
// what is wider than the window moves under the keys, too
function scrollable(frame, table) {
  new ResizeObserver(() => {
    const wide = frame.scrollWidth > frame.clientWidth + 1;
    if (wide) {
      frame.tabIndex = 0;
      frame.setAttribute("role", "region");
      frame.setAttribute("aria-label", `${table.caption?.textContent ?? "table"}, wider than the window`);
    } else ["tabindex", "role", "aria-label"].forEach(name => frame.removeAttribute(name));
  }).observe(frame);
}
document.querySelectorAll("table.data").forEach(equipTable);
