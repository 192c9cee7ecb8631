// The address names the project (`/?project=...`), and so does the address of the websocket, which viser leaves without.
(() => {
  const post = Worker.prototype.postMessage;
  let worker, server;
  const address = () => {
    const name = new URLSearchParams(location.search).get("project");
    return name === null ? server : `${server}/?project=${encodeURIComponent(name)}`;
  };
  Worker.prototype.postMessage = function (data, ...rest) {
    if (data?.type !== "set_server") return post.call(this, data, ...rest);
    [worker, server] = [this, data.server.replace(/\/$/, "")];
    this.addEventListener("message", ({ data: { type } }) => {
      if (type === "connected" || type === "closed") window.__dioConnection(type === "connected");
    });
    return post.call(this, { ...data, server: address() }, ...rest);
  };
  const connect = () => worker && post.call(worker, { type: "set_server", server: address() });
  // Until the other project's page is there, viser would show a panel of its own.
  const leave = () => {
    document.getElementById("dio-toolbar")?.remove();
    document.documentElement.classList.remove("dio-ready");
    connect();
  };
  window.__dioGoTo = (name) => {
    const query = new URLSearchParams(location.search);
    if (query.get("project") === name) return;
    query.set("project", name);
    history.pushState(null, "", `?${query}`);
    leave();
  };
  addEventListener("popstate", leave);
})();
