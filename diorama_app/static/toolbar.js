// The toolbar's menu of less frequent tools. It stays open while its switches are used, and closes with Escape or a
// press elsewhere. The bar is drawn anew with every change: what is open is kept on the page itself.
(() => {
  const root = document.documentElement, OPEN = "dio-menu";
  const opener = () => document.querySelector("#dio-toolbar [data-menu]");
  const show = (open) => {
    root.classList.toggle(OPEN, open);
    opener()?.setAttribute("aria-expanded", String(open));
  };
  addEventListener("click", (event) => {
    if (event.target.closest?.("#dio-toolbar [data-menu]")) show(!root.classList.contains(OPEN));
    else if (event.target.closest?.("#dio-toolbar .menu [data-closes]")) show(false);
  }, true);
  addEventListener("pointerdown", (event) => {
    if (!event.target.closest?.("#dio-toolbar")) show(false);
  }, true);
  addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !root.classList.contains(OPEN)) return;
    event.stopImmediatePropagation();
    show(false);
    opener()?.focus();
  }, true);
  addEventListener("DOMContentLoaded", () => {
    new MutationObserver(() => show(root.classList.contains(OPEN))).observe(document.body, { childList: true });
  });
})();
