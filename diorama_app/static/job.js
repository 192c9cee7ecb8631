// The strip of the running job, always in view. It is told what runs (panels/job.py) and stays while that changes, so that
// its buttons can be pressed at any moment.
(() => {
  let strip;
  const send = (what) => {
    const button = document.getElementById("dio-job-send");
    if (!button) return;
    button.dataset.do = what;
    button.click();
  };
  const make = (tag, more = {}) => Object.assign(document.createElement(tag), more);
  const build = () => {
    strip = make("section", { id: "dio-job", role: "status" });
    strip.setAttribute("aria-label", _("Running job"));
    const header = make("header");
    header.append(make("b"), make("button", { type: "button", className: "pause", onclick: () => send("pause") }),
      make("button", { type: "button", className: "cancel", textContent: _("Cancel"), onclick: () => send("cancel") }));
    const now = make("div", { className: "now" });
    now.append(make("span", { className: "stage" }), make("span", { className: "left" }));
    const meter = make("progress", { max: 100 });
    meter.setAttribute("aria-label", _("Progress"));
    strip.append(header, meter, now, make("div", { className: "found", lang: "en" }));
    document.body.append(strip);
  };
  window.__dioJob = (job) => {
    if (!strip) { if (!job) return; build(); }
    strip.hidden = !job;
    if (!job) return;
    const part = (name) => strip.querySelector(name);
    part("b").textContent = job.title;
    part("progress").value = job.percent;
    part(".stage").textContent = job.stage;
    part(".stage").lang = job.lang;
    part(".left").textContent = job.left;
    part(".found").textContent = job.found;
    part(".pause").hidden = !job.pause;
    part(".pause").textContent = job.pause || "";
    part(".cancel").disabled = job.cancelling;
  };
})();
