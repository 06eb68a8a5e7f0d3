// The drop as it moves: journal, ring, balls, cage and forces, drawn on canvases, and what plays it.
touchdown.motion = (() => {
  "use strict";
  const { element, button, paint, floats, readData } = touchdown;
  const TURN = 2 * Math.PI;
  const LEAST = 0.004; // of the largest force: what has an arrow
  const PACES = [1000, 300, 100, 30, 10, 3, 1]; // times slower, beside the one that slows down by itself
  const PAUSE = 0.1; // s, after which a page that was not shown goes on

  const arrow = (pen, [x, y], [nx, ny], length, thin) => {
    const tip = [x + length * nx, y + length * ny];
    const head = Math.min(0.16, 0.5 * length);
    pen.strokeStyle = pen.fillStyle = paint("alarm");
    pen.lineWidth = 3 * thin;
    pen.beginPath();
    pen.moveTo(x, y);
    pen.lineTo(tip[0] - head * nx, tip[1] - head * ny);
    pen.stroke();
    pen.beginPath();
    pen.moveTo(...tip);
    pen.lineTo(tip[0] - head * nx + 0.5 * head * ny, tip[1] - head * ny - 0.5 * head * nx);
    pen.lineTo(tip[0] - head * nx - 0.5 * head * ny, tip[1] - head * ny + 0.5 * head * nx);
    pen.fill();
  };

  // A canvas as sharp as the screen, with the origin in its middle and y upwards; `reach` is its half.
  const prepared = (canvas, reach) => {
    const size = Math.round(canvas.clientWidth * (window.devicePixelRatio || 1));
    if (canvas.width !== size) canvas.width = canvas.height = size;
    const pen = canvas.getContext("2d");
    const scale = (0.5 * size) / reach;
    pen.setTransform(scale, 0, 0, -scale, 0.5 * size, 0.5 * size);
    pen.clearRect(-reach, -reach, 2 * reach, 2 * reach);
    return { pen, thin: (2.4 * reach) / canvas.clientWidth };
  };

  const drawAlong = (canvas, data, { journal, ring, turned, force }) => {
    const { pen, thin } = prepared(canvas, data.pitch ? 1.06 * (data.pitch + 1.35 * data.ball) : 1.3 * data.bore);
    const circle = (x, y, radius, stroke, fill, width = 1) => {
      pen.beginPath();
      pen.arc(x, y, radius, 0, TURN);
      if (fill) { pen.fillStyle = paint(fill); pen.fill(); }
      if (stroke) { pen.strokeStyle = paint(stroke); pen.lineWidth = width * thin; pen.stroke(); }
    };
    const mark = (x, y, angle, from, to, word, width) => {
      pen.beginPath();
      pen.moveTo(x + from * Math.cos(angle), y + from * Math.sin(angle));
      pen.lineTo(x + to * Math.cos(angle), y + to * Math.sin(angle));
      pen.strokeStyle = paint(word);
      pen.lineWidth = width * thin;
      pen.stroke();
    };
    const [jx, jy, ja] = journal;
    const [rx, ry, ra] = ring;
    if (data.pitch) {
      circle(0, 0, data.pitch + 1.35 * data.ball, "edge", "core");
      circle(0, 0, data.pitch + 0.8 * data.ball, "edge", "paper");
      circle(rx, ry, data.pitch - 0.8 * data.ball, "edge", "core");
      circle(rx, ry, data.bore, "edge", "paper");
      mark(rx, ry, ra, data.bore, data.pitch - 0.8 * data.ball, "blue", 3);
      if (data.caged) circle(0, 0, data.pitch, "purple", null, 2.5);
      for (let b = 0; b < data.count; b += 1) {
        const angle = turned + (b * TURN) / data.count;
        const at = [data.pitch * Math.cos(angle), data.pitch * Math.sin(angle)];
        circle(...at, data.ball, b ? "edge" : "blue", "raised", b ? 1 : 2);
      }
    } else {
      circle(0, 0, 1.22 * data.bore, "edge", "sleeve");
      circle(0, 0, data.bore, "edge", "paper");
    }
    circle(jx, jy, 1, "orange", "raised", 2);
    mark(jx, jy, ja, 0, 1, "orange", 2);
    const [fx, fy] = force;
    const size = Math.hypot(fx, fy);
    if (size > LEAST) arrow(pen, [jx - fx / size, jy - fy / size], [fx / size, fy / size], 0.12 + data.push * size, thin);
  };

  // The bearing from the side: what stands at (y, z) in a body goes with its displacement and tilt.
  const drawSide = (canvas, side, { rotor, ring, push }) => {
    const { pen, thin } = prepared(canvas, 1.04 * Math.max(...side.reach));
    const [across, along] = side.magnified;
    const moved = ([y, z], [dy, dz, tilt]) => {
      const at = [y + dy - across * tilt * z, z + dz + along * tilt * y];
      return side.upright ? at : at.reverse();
    };
    const filled = (fill, stroke, width) => {
      pen.fillStyle = paint(fill);
      pen.fill();
      pen.strokeStyle = paint(stroke);
      pen.lineWidth = width * thin;
      pen.stroke();
    };
    const outline = (corners, motion, stroke, fill, width) => {
      pen.beginPath();
      corners.forEach((corner) => pen.lineTo(...moved(corner, motion)));
      pen.closePath();
      filled(fill, stroke, width);
    };
    side.outer.forEach((corners) => outline(corners, [0, 0, 0], "edge", side.ball ? "core" : "sleeve", 1));
    side.ring.forEach((corners) => outline(corners, ring, "edge", "core", 1));
    for (const ball of side.balls) {
      pen.beginPath();
      pen.arc(...moved(ball, ring.map((v) => 0.5 * v)), side.ball, 0, TURN); // they roll along at half its rate
      filled("raised", "edge", 1);
    }
    outline(side.rotor, rotor, "orange", "raised", 2);
    if (Math.abs(push) > LEAST) {
      const to = side.upright ? [0, Math.sign(push)] : [Math.sign(push), 0];
      arrow(pen, moved([0, 0], rotor), to, side.push * Math.abs(push), thin);
    }
  };

  // -- moments ---------------------------------------------------------------------------------------

  // Of values in rows of `width`: row k, and what lies `part` of the way from there to the next.
  const row = (values, width, k) => values.subarray(width * k, width * (k + 1));
  const between = (values, width, { k, part }) => {
    if (!part) return row(values, width, k);
    const next = row(values, width, k + 1);
    return row(values, width, k).map((v, i) => v + part * (next[i] - v));
  };

  // The frame at or before a time, and which part of the way to the next has gone.
  const place = (time, now) => {
    let [low, high] = [0, time.length - 1];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (time[middle] <= now) low = middle; else high = middle;
    }
    if (now >= time[high]) return { k: high, part: 0 };
    return { k: low, part: Math.max(0, (now - time[low]) / (time[high] - time[low])) };
  };

  const unpack = (data, names) => names.forEach((name) => { data[name] = floats(data[name]); });

  const clock = (seconds) => (Math.abs(seconds) < 1 ? `${(1e3 * seconds).toFixed(2)} ms` : `${seconds.toFixed(4)} s`);

  const picture = (parent, title, what) => {
    const holder = element("div", parent);
    element("h3", holder, title);
    const canvas = element("canvas", holder);
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `${what} as they move`);
    return { canvas, told: element("p", holder) };
  };

  // The pictures of a seat; returns what draws them at a place among the frames.
  const seat = (parent, data, time) => {
    unpack(data, ["journal", "ring", "balls", "force", "rpm"]);
    const along = picture(parent, data.title, `Journal, ring and balls of ${data.title}`);
    const { side } = data;
    if (side) unpack(side, ["moves", "rings", "force"]);
    along.told.classList.toggle("staged", data.stages.length > 0);
    const beside = side && picture(parent, `${data.title}, from the side`, `Rotor and ring of ${data.title} along the shaft`);

    const tell = ({ k, part }, force) => {
      const [rotor, ring] = between(data.rpm, 2, { k, part }).map(Math.round);
      const now = time[k] + part * ((time[k + 1] ?? time[k]) - time[k]);
      const stage = data.stages.findLast(([since]) => since <= now);
      along.told.textContent = `rotor ${rotor} rpm` + (data.pitch ? `, ring ${ring} rpm` : "")
        + `, force ${(data.largest * Math.hypot(...force)).toFixed(0)} N` + (stage ? `, ${stage[1]}` : "");
    };
    const drawBeside = (at, near) => {
      const pose = { rotor: between(side.moves, 3, at), ring: between(side.rings, 3, at), push: side.force[near] };
      drawSide(beside.canvas, side, pose);
      const um = (motion) => ((1e6 * side.unit) / side.magnified[1]) * motion[1];
      beside.told.textContent = `along: rotor ${um(pose.rotor).toFixed(0)} µm`
        + (side.ball ? `, ring ${um(pose.ring).toFixed(1)} µm` : "") + `, force ${(side.largest * Math.abs(pose.push)).toFixed(0)} N`;
    };
    return (at) => {
      const near = at.k + Math.round(at.part); // a force is the largest about its frame
      const force = row(data.force, 2, near);
      const moved = { journal: between(data.journal, 3, at), ring: between(data.ring, 3, at) };
      drawAlong(along.canvas, data, { ...moved, turned: between(data.balls, 1, at)[0], force });
      tell(at, force);
      if (side) drawBeside(at, near);
    };
  };

  // -- playing ---------------------------------------------------------------------------------------

  // How many times slower it goes at a time, by what was chosen: by itself ("") or one of PACES.
  const slowness = (chosen, pace, now) => Number(chosen) || (pace.find(([, end]) => now < end) ?? pace[pace.length - 1])[0];

  const choice = (tools) => {
    const made = element("select", tools);
    made.setAttribute("aria-label", "Slow motion");
    element("option", made, "automatic").value = "";
    for (const times of PACES) element("option", made, times > 1 ? `${times} times slower` : "real time").value = times;
    return made;
  };

  // Draws the first hard contact, and plays; tells each moment shown by the event "moment" of the figure.
  return (figure) => {
    const data = readData(figure);
    const time = floats(data.time, Float64Array);
    const last = time.length - 1;
    const stage = figure.querySelector(".stage");
    figure.querySelector(".noscript").remove();
    stage.hidden = false;
    const pictures = element("div", stage);
    pictures.className = "seats";
    const drawn = data.seats.map((one) => seat(pictures, one, time));
    const tools = element("div", stage);
    tools.className = "tools player";
    let now = time[0];
    let playing = null; // when it was drawn last, ms
    let fresh = true; // nobody chose a moment yet

    const show = (to) => {
      now = Math.max(time[0], Math.min(time[last], to));
      const at = place(time, now);
      drawn.forEach((draw) => draw(at));
      const times = Math.round(slowness(pace.value, data.pace, now));
      slider.value = at.k;
      told.textContent = `${clock(now)} after the shutdown, ${times > 1 ? `${times} times slower` : "real time"}`;
      slider.setAttribute("aria-valuetext", told.textContent);
      figure.dispatchEvent(new CustomEvent("moment", { detail: now }));
    };
    const stop = () => { playing = null; play.textContent = "Play"; };
    const seek = (to) => { stop(); fresh = false; show(to); };
    const step = (by) => {
      const { k, part } = place(time, now);
      seek(time[Math.max(0, Math.min(last, k + by + (part && by < 0 ? 1 : 0)))]);
    };
    const tick = (stamp) => {
      if (playing === null) return;
      const gone = Math.min(PAUSE, Math.max(0, stamp - playing) / 1000);
      playing = stamp;
      show(now + gone / slowness(pace.value, data.pace, now));
      if (now >= time[last]) stop(); else requestAnimationFrame(tick);
    };
    const toggle = () => {
      if (playing !== null) { stop(); return; }
      if (fresh || now >= time[last]) now = data.begin;
      fresh = false;
      playing = performance.now();
      play.textContent = "Pause";
      requestAnimationFrame(tick);
    };

    const play = button(tools, "Play", "", toggle);
    button(tools, "‹", "One frame back", () => step(-1));
    button(tools, "›", "One frame on", () => step(1));
    const pace = choice(tools);
    pace.addEventListener("change", () => show(now));
    const slider = element("input", tools);
    Object.assign(slider, { type: "range", min: 0, max: last, value: 0 });
    slider.setAttribute("aria-label", "Moment of the drop");
    slider.addEventListener("input", () => seek(time[Number(slider.value)]));
    const told = element("output", tools);
    const redraw = () => show(now);
    window.addEventListener("repaint", redraw);
    window.addEventListener("resize", redraw);

    const presses = (k) => data.seats.some(({ force, side }) => Math.hypot(...row(force, 2, k)) > 0.3 || Math.abs(side ? side.force[k] : 0) > 0.3);
    show(time[Math.max(0, time.findIndex((_, k) => presses(k)))]);
    return { tools, pace, seek, step, toggle, moment: () => now, first: time[0], last: time[last] };
  };
})();
