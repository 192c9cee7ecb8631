// Runs before viser's page does. Where WebGL draws on the processor, a frame costs what all else on the machine does:
// there edges are not smoothed, and a change is drawn once and once more when all is quiet, not for a quarter second.
(() => {
  const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;
  const QUIET_MS = 120;
  const original = HTMLCanvasElement.prototype.getContext;
  let software;

  const drawsInSoftware = () => {
    if (software === undefined) {
      const gl = original.call(document.createElement("canvas"), "webgl2", { antialias: false });
      const names = gl && gl.getExtension("WEBGL_debug_renderer_info");
      software = Boolean(names && SOFTWARE.test(gl.getParameter(names.UNMASKED_RENDERER_WEBGL)));
      gl?.getExtension("WEBGL_lose_context")?.loseContext();
    }
    return software;
  };

  HTMLCanvasElement.prototype.getContext = function (kind, options) {
    const smoothed = options?.antialias && kind === "webgl2";
    return original.call(this, kind, smoothed && drawsInSoftware() ? { ...options, antialias: false } : options);
  };

  let page;
  Object.defineProperty(window, "__viserMutable", {
    configurable: true,
    get: () => page,
    set: (mutable) => {
      page = mutable;
      if (mutable && drawsInSoftware()) drawSparingly(mutable);
    },
  });

  function drawSparingly(mutable) {
    const draw = () => mutable.scene?.__r3f.root.getState().invalidate();
    let later;
    mutable.requestRender = () => {
      draw();
      clearTimeout(later);
      later = setTimeout(draw, QUIET_MS);
    };
  }
})();
