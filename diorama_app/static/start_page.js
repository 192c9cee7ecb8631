// The start page opens by itself in a tab until somebody has done something there, where the program was started without a
// project: what a lost connection took away, or never brought, is asked for again. Its labels that stand for file fields are
// pressed by keys, too, and newcomers are shown around when it closes. The focus stays in it, as it does in the grid of all
// projects.
(() => {
  const BEGUN = "diorama-begun", WANTED = "diorama-tour-wanted";
  const note = (key, value) => { try { sessionStorage.setItem(key, value); } catch { return; } };
  const noted = (key) => { try { return sessionStorage.getItem(key); } catch { return "not remembered"; } };
  const OVER = "#dio-start, #dio-projects";
  const PATIENCE_MS = 3000; // an answer that takes longer is not coming
  let open = false, asked = -Infinity;
  setInterval(() => {
    const opener = document.getElementById("dio-start-open"), page = document.querySelector(OVER), now = performance.now();
    const wanted = opener?.dataset.auto !== undefined && !page && !noted(BEGUN);
    if (wanted && now - asked > PATIENCE_MS && document.documentElement.classList.contains("dio-ready")) {
      asked = now;
      opener.click();
    }
    if (page && !open) page.querySelector(".choose, [type=search]")?.focus();
    open = page !== null;
  }, 200);
  for (const done of ["pointerdown", "keydown", "click", "drop"]) {
    addEventListener(done, (event) => event.isTrusted && document.querySelector(OVER) && note(BEGUN, "yes"), true);
  }
  addEventListener("click", (event) => {
    const chosen = event.target.closest?.("#dio-start [data-do]")?.dataset.do;
    if (["example", "empty", "close"].includes(chosen)) note(WANTED, chosen === "close" ? "here" : location.search);
  }, true);
  addEventListener("keydown", (event) => {
    if ((event.key === "Enter" || event.key === " ") && event.target.matches?.("#dio-start label.choose")) {
      event.preventDefault();
      event.target.click();
    }
    if (!open) return;
    // viser hears no key in a field.
    if (event.key === "Escape" && event.target.matches?.("[type=search]")) {
      document.querySelector(`:is(${OVER}) [data-do=close]`)?.click();
    }
    const own = ["Tab", "Escape", "Enter", " "].includes(event.key) || event.target.matches?.("input, textarea, select");
    if (!own) event.stopImmediatePropagation(); // it would change the view behind
    if (event.key !== "Tab") return;
    const reached = [...document.querySelectorAll(`:is(${OVER}) :is(button, input, select, textarea, summary, [tabindex])`)]
      .filter((field) => field.offsetParent && !field.disabled);
    const first = reached[0], last = reached[reached.length - 1];
    if (event.shiftKey && document.activeElement === first) { event.preventDefault(); last?.focus(); }
    if (!event.shiftKey && document.activeElement === last) { event.preventDefault(); first?.focus(); }
  }, true);
})();
