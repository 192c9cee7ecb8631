// Runs before viser's page does, and matters where WebGL draws on the processor: there a picture takes what all else on
// the machine needs, and the page waits for it. So edges are not smoothed; a change is drawn once, and once more when
// all is quiet (viser draws for a quarter second); what moves is drawn with fewer pixels until it rests; what was only
// added is drawn when it is there; and what a hand drags when the server has said where it is.
(() => {
  const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;
  const QUIET_MS = 300;
  const REPLY_MS = 80; // for the server to say where the thing in the hand is now
  const MOUNT_MS = 50; // for React to put in place what came together
  const PARSE_MS = 250; // for a model to be read
  const COARSE = 0.5; // pixels of the picture for one of the screen, both ways, while something moves
  const HEARTBEAT_MS = [1000, 10000]; // viser's pictures of a page at rest: how often, and how often here
  const MOVES = /^(SetPosition|SetOrientation|SetBonePosition|SetBoneOrientation|SetCamera)/;
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

  const every = window.setInterval;
  window.setInterval = (call, ms, ...rest) => {
    const beat = ms === HEARTBEAT_MS[0] && drawsInSoftware();
    return every.call(window, call, beat ? HEARTBEAT_MS[1] : ms, ...rest);
  };

  let page;
  Object.defineProperty(window, "__viserMutable", {
    configurable: true,
    get: () => page,
    set: (mutable) => {
      page = mutable;
      if (mutable?.scene && drawsInSoftware()) drawSparingly(mutable);
    },
  });

  function drawSparingly(mutable) {
    const store = mutable.scene.__r3f.root;
    const { gl: renderer, invalidate } = store.getState();
    const given = new URLSearchParams(location.search).get("fixedDpr");
    const fixed = given === null ? undefined : Number(given);
    let moving = false; // since the last picture of a page at rest
    let looking = false; // the camera moved from the last picture to this one
    let seenFrom;
    let due; // [when, timer] of the next picture
    let rest;
    let look;
    const awaited = new Set(); // the names of those that came after the last picture and are not read yet

    const draw = () => {
      clearTimeout(due?.[1]);
      due = undefined;
      awaited.clear();
      invalidate();
    };
    const drawWithin = (wait) => {
      const when = performance.now() + wait;
      if (due && due[0] <= when) return;
      clearTimeout(due?.[1]);
      due = [when, setTimeout(draw, wait)];
    };
    const restSoon = () => {
      clearTimeout(rest);
      rest = setTimeout(() => {
        moving = false;
        draw();
      }, QUIET_MS);
    };

    // The number of pixels changes right before a picture is drawn: a canvas that changes its size is empty until then.
    const render = renderer.render.bind(renderer);
    renderer.render = (scene, camera) => {
      if (camera === mutable.camera && renderer.getRenderTarget() === null) {
        // Not viser's own number: it falls where pictures are slow, and stays there.
        const ratio = fixed ?? devicePixelRatio * (moving ? COARSE : 1);
        if (renderer.getPixelRatio() !== ratio) renderer.setPixelRatio(ratio);
        looking = seenFrom !== undefined && !camera.matrixWorld.equals(seenFrom);
        seenFrom = camera.matrixWorld.clone();
      }
      render(scene, camera);
    };

    const isThere = (name) => {
      let meshes = 0;
      mutable.nodeRefFromName[name]?.traverse((part) => (meshes += part.isMesh ? 1 : 0));
      return meshes > 0;
    };
    const drawWhenThere = () => {
      look = undefined;
      const came = [...awaited].filter(isThere);
      came.forEach((name) => awaited.delete(name));
      if (came.length > 0 && awaited.size === 0) draw();
      else drawWithin(awaited.size > 0 ? PARSE_MS : MOUNT_MS);
    };

    // React asks while it puts things in place, and the camera's controls while they glide.
    const mounted = () => {
      if (looking) draw();
      else look ??= setTimeout(drawWhenThere);
    };
    store.setState({ invalidate: mounted });

    let draining = false; // what messages ask for while they are carried out, React will ask for again
    const requestRender = () => {
      if (draining) return;
      const queue = mutable.messageQueue;
      moving = true;
      restSoon();
      const models = queue.filter((message) => message.type === "GlbMessage");
      if (queue.length === 0) {
        if (mutable.cameraControl?.enabled === false) drawWithin(REPLY_MS);
        else draw();
      } else if (models.length === 0 && queue.some((message) => MOVES.test(message.type))) {
        draw();
      } else if (mutable.getRenderRequestState !== "ready") {
        draw();
      } else {
        models.forEach((message) => awaited.add(message.name));
        draining = true;
        try {
          mutable.drainMessageQueue?.();
        } finally {
          draining = false;
        }
        mounted();
      }
    };
    // viser puts its own back whenever React has a new way to ask for pictures.
    Object.defineProperty(mutable, "requestRender", { get: () => requestRender, set: () => {} });
  }
})();
