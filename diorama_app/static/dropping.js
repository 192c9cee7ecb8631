// Files and folders that are dropped anywhere on the page go to the server in one upload: a single file as it is,
// several in a zip archive without compression. What they are, the server says.
(() => {
  const MOST = 128 * 1024 * 1024; // what the server takes; of more it says so by the size, so nothing is read
  const TABLE = Uint32Array.from({ length: 256 }, (_, n) => {
    for (let k = 0; k < 8; k++) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
    return n;
  });

  const crc = (bytes) => {
    let sum = -1;
    for (const byte of bytes) sum = TABLE[(sum ^ byte) & 255] ^ (sum >>> 8);
    return (sum ^ -1) >>> 0;
  };

  // Numbers of two and four bytes, low byte first: [size, value] pairs.
  const header = (...fields) => {
    const view = new DataView(new ArrayBuffer(fields.reduce((sum, [size]) => sum + size, 0)));
    let at = 0;
    for (const [size, value] of fields) {
      size === 2 ? view.setUint16(at, value, true) : view.setUint32(at, value, true);
      at += size;
    }
    return view.buffer;
  };

  const zipped = async (files) => {
    const parts = [], directory = [];
    let at = 0;
    for (const { path, file } of files) {
      const bytes = new Uint8Array(await file.arrayBuffer()), name = new TextEncoder().encode(path);
      // Version 2.0, names in UTF-8, stored, no date, checksum and sizes, length of the name, no extra field.
      const about = [[2, 20], [2, 0x800], [2, 0], [4, 0x210000], [4, crc(bytes)], [4, bytes.length], [4, bytes.length],
        [2, name.length], [2, 0]];
      parts.push(header([4, 0x04034b50], ...about), name, bytes);
      directory.push(header([4, 0x02014b50], [2, 20], ...about, [2, 0], [2, 0], [2, 0], [4, 0], [4, at]), name);
      at += 30 + name.length + bytes.length;
    }
    const size = directory.reduce((sum, part) => sum + part.byteLength, 0);
    const end = header([4, 0x06054b50], [2, 0], [2, 0], [2, files.length], [2, files.length], [4, size], [4, at], [2, 0]);
    return [...parts, ...directory, end];
  };

  const inFolder = async (folder) => {
    const reader = folder.createReader(), found = [];
    for (;;) {
      const some = await new Promise((good, bad) => reader.readEntries(good, bad)); // a hundred at a time
      if (!some.length) return (await Promise.all(found.map(below))).flat();
      found.push(...some);
    }
  };
  const below = async (entry) => {
    if (entry.name.startsWith(".")) return [];
    if (entry.isDirectory) return inFolder(entry);
    const file = await new Promise((good, bad) => entry.file(good, bad));
    return [{ path: entry.fullPath.replace(/^\//, ""), file }];
  };

  const uploadField = () => {
    const to = document.getElementById("dio-drop-to");
    return to && document.getElementById(`file_upload_${to.dataset.upload}`);
  };
  const send = async (file) => {
    while (!uploadField()) await new Promise((done) => setTimeout(done, 100)); // the panels are still on their way
    const field = uploadField();
    const one = new DataTransfer();
    one.items.add(file);
    field.files = one.files;
    field.dispatchEvent(new Event("change", { bubbles: true }));
  };

  const take = async (entries, loose) => {
    const files = entries.length ? (await Promise.all(entries.map(below))).flat() : loose.map((file) => ({ path: file.name, file }));
    if (!files.length) return;
    if (files.length === 1 && !entries.some((e) => e.isDirectory)) return send(files[0].file);
    const name = entries.length === 1 ? entries[0].name : `${files.length} files`;
    const size = files.reduce((sum, { file }) => sum + file.size, 0);
    send(new File(size > MOST ? files.map(({ file }) => file) : await zipped(files), `${name}.zip`));
  };

  const holds = (event) => event.dataTransfer && [...event.dataTransfer.types].includes("Files");
  let veil, depth = 0;
  const show = (on) => {
    veil ??= document.body.appendChild(Object.assign(document.createElement("div"), {
      id: "dio-drop",
      textContent: _("Drop photos, boxes, masks, depth, models, a scan or a scene: files or a folder"),
    }));
    veil.style.display = on ? "flex" : "none";
    if (!on) depth = 0;
  };
  addEventListener("dragenter", (event) => holds(event) && (depth++, show(true)));
  addEventListener("dragleave", (event) => holds(event) && --depth <= 0 && show(false));
  addEventListener("dragover", (event) => holds(event) && event.preventDefault());
  addEventListener("drop", (event) => {
    if (!holds(event)) return;
    event.preventDefault();
    show(false);
    const entries = [...event.dataTransfer.items].map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
    take(entries, [...event.dataTransfer.files]);
  });
})();
