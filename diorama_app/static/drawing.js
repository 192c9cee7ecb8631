// Runs before viser's page does, and matters where WebGL draws on the processor: there a picture takes what all else on
// the machine needs, and the page waits for it. So edges are not smoothed; a change is drawn once, and once more when
// all is quiet (viser draws for a quarter second); of moved objects only the part of the picture that they were and are
// in (region.js); where that is most of it, and while the camera moves, with fewer pixels until it rests; what was only
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
  const MOVES_OBJECT = /^Set(Position|Orientation)Message$/;
  const OBJECT = /^\/objects\/\d+$/;
  const BESIDE = /^(Gui|Notification)/; // nothing of the view
  const MOST = 0.4; // of the canvas: beyond it all of it is drawn, with fewer pixels
  const MANY = 12; // objects that move together are all over the room
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
    let moving = false; // coarsely, since the last picture of a page at rest
    let whole = true; // whether the next picture is of everything
    const moved = new Set(); // the objects that are in other places in the next picture
    let part = null; // where they were
    let before = null; // what the picture before was of, if not of everything
    let since = null; // what was drawn since all was at rest
    let looking = false; // the camera moved from the last picture to this one
    let seenFrom;
    let due; // [when, timer] of the next picture
    let rest;
    let look;
    const awaited = new Set(); // the names of those that came after the last picture and are not read yet

    const drawNext = () => {
      clearTimeout(due?.[1]);
      due = undefined;
      awaited.clear();
      invalidate();
    };
    const draw = () => {
      whole = true;
      drawNext();
    };
    const drawWithin = (wait, then = draw) => {
      const when = performance.now() + wait;
      if (due && due[0] <= when) return;
      clearTimeout(due?.[1]);
      due = [when, setTimeout(then, wait)];
    };
    const restSoon = () => {
      clearTimeout(rest);
      rest = setTimeout(() => {
        if (moving || !since) return void ((moving = false), draw());
        part = Region.union(part, since); // labels follow their objects a picture late
        drawNext();
      }, QUIET_MS);
    };

    const Region = window.__dioRegion;
    const noteMoves = (queue) => {
      const news = queue.filter(({ type }) => !BESIDE.test(type));
      const names = new Set(news.map(({ name }) => name));
      whole ||= names.size > MANY || news.some(({ type, name }) => !MOVES_OBJECT.test(type) || !OBJECT.test(name));
      for (const name of names) {
        if (whole) return;
        if (moved.has(name)) continue;
        moved.add(name);
        const was = Region.of(mutable, name);
        if (was) part = Region.union(part, was);
        whole = !was || Region.share(mutable, part) > MOST;
      }
    };
    // What the next picture is of; null: of everything.
    const partOfPicture = (scene) => {
      if (whole || !(part || before) || shadowed(scene)) return null;
      scene.updateMatrixWorld();
      let region = Region.union(part, before);
      for (const name of moved) {
        const is = Region.of(mutable, name);
        if (!is) return null;
        region = Region.union(region, is);
      }
      return region && Region.share(mutable, region) < MOST ? region : null;
    };
    const shadowed = (scene) => {
      let casts = false;
      scene.traverseVisible((o) => (casts ||= o.isLight && o.castShadow));
      return casts;
    };

    // The number of pixels changes right before a picture is drawn: a canvas that changes its size is empty until then.
    const render = renderer.render.bind(renderer);
    renderer.render = (scene, camera) => {
      if (camera !== mutable.camera || renderer.getRenderTarget() !== null) return render(scene, camera);
      camera.updateMatrixWorld();
      const sees = [camera.matrixWorld, camera.projectionMatrix];
      looking = seenFrom !== undefined && !sees.every((matrix, k) => matrix.equals(seenFrom[k]));
      seenFrom = sees.map((matrix) => matrix.clone());
      const region = looking ? null : partOfPicture(scene);
      const drewAll = region === null;
      if (drewAll) {
        // Not viser's own number: it falls where pictures are slow, and stays there.
        moving ||= moved.size > 0;
        const ratio = fixed ?? devicePixelRatio * (moving ? COARSE : 1);
        if (renderer.getPixelRatio() !== ratio) renderer.setPixelRatio(ratio);
        render(scene, camera);
      } else {
        Region.draw(mutable, renderer, render, scene, camera, region);
      }
      since = drewAll || moved.size === 0 ? null : Region.union(since, region);
      before = drewAll || moved.size === 0 ? null : region;
      whole = false;
      part = null;
      moved.clear();
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
      whole = true;
      if (looking) draw();
      else look ??= setTimeout(drawWhenThere);
    };
    // Viser lowers the number of pixels where pictures are slow; a canvas that it empties would show parts of a picture.
    store.setState({ invalidate: mounted, setDpr: () => {} });

    let draining = false; // what messages ask for while they are carried out, React will ask for again
    const requestRender = () => {
      if (draining) return;
      const queue = mutable.messageQueue;
      const models = queue.filter((message) => message.type === "GlbMessage");
      const moves = models.length === 0 && queue.some((message) => MOVES.test(message.type));
      const held = queue.length === 0 && mutable.cameraControl?.enabled === false;
      if (moves) noteMoves(queue);
      if (!held) moving ||= !moves || whole;
      restSoon();
      if (held) {
        drawWithin(REPLY_MS, () => ((moving = true), draw()));
      } else if (queue.length === 0) {
        draw();
      } else if (moves) {
        drawNext();
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
