// Rows of lists and trees by keys: arrows go from row to row, Enter and space choose, F2 renames where a row can be.
(() => {
  const ROW = ".dio .row[role=treeitem]";
  const rename = (row) => {
    const name = row.querySelector(".name");
    if (!row.dataset.rename || !name || name.querySelector("input")) return;
    const field = Object.assign(document.createElement("input"), { value: row.dataset.rename });
    field.dataset.change = "rename";
    field.dataset.arg = row.dataset.arg;
    field.setAttribute("aria-label", _("New name of {label}").replace("{label}", row.dataset.rename));
    field.onclick = (event) => event.stopPropagation();
    const before = name.textContent;
    const back = () => { name.textContent = before; };
    field.onblur = back;
    field.onkeydown = (event) => {
      event.stopPropagation();
      if (event.key === "Escape") { field.onblur = null; back(); row.focus(); }
      if (event.key === "Enter") row.focus();
    };
    row.draggable = false;
    name.replaceChildren(field);
    field.focus();
    field.select();
  };
  addEventListener("keydown", (event) => {
    const row = event.target.matches?.(ROW) ? event.target : null;
    if (!row || event.ctrlKey || event.metaKey || event.altKey) return;
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    const rows = [...row.closest("[role=tree]").querySelectorAll(ROW)];
    if (step) rows[rows.indexOf(row) + step]?.focus();
    else if (event.key === "Home") rows[0].focus();
    else if (event.key === "End") rows.at(-1).focus();
    else if (event.key === "Enter" || event.key === " ") row.click();
    else if (event.key === "F2") rename(row);
    else return;
    event.preventDefault();
    event.stopImmediatePropagation();
  }, true);
  addEventListener("dblclick", (event) => {
    const row = event.target.closest?.(ROW);
    if (row && event.target.closest(".name")) rename(row);
  });
})();
