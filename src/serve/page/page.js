// serve/page/page.js - joins the controls, the picture and the server; all starts here.
// SPDX-License-Identifier: Apache-2.0
import {
  Problem, View, callJson, hasToken, rememberFile, setToken, takeFragment, upload,
} from "/api.js";
import {
  controls, currentPlace, currentPose, element, form, listEnvironment, optionsOf, placedCamera,
  showAsset, showChoices, showFiles, showTones, showValues, wishSize,
} from "/panel.js";
import {draw, fitted, moveOfKey, tint, watchPointers, wipe} from "/stage.js";

const matteColor = [255, 150, 40];
const mostNodes = 500;

const byId = (id) => document.getElementById(id);
const canvas = byId("picture");
const stage = byId("stage");

let view = null;  // the open file
let camera = null;  // the orbit camera, once the view was moved
let sharp = null;  // the point that was picked to be sharp
let picked = null;  // the node whose matte is shown
let matteWish = 0;  // the wish whose matte lies over the picture
let playStart = null;  // when an animation that plays was at 0 s

// ---- What is wrong, and what is going on ----

const problems = new Map();

function problemText({place, message, also = []}) {
  const more = also.map((other) => `\n${other.place ?? ""} ${other.text ?? other}`);
  const text = ` ${place ? `${place}: ` : ""}${message}${more.join("")}`;
  return text.replace(/upload:[0-9a-f]{64}\//g, "");  // people know a sent file by its name
}

function showProblems() {
  const rows = [...problems].map(([source, problem]) => {
    const row = element("p", "");
    const close = element("button", "×", {type: "button", onclick: () => solve(source)});
    close.setAttribute("aria-label", `Dismiss ${problem.id}`);
    row.append(element("b", problem.id), problemText(problem), close);
    return row;
  });
  byId("errors").replaceChildren(...rows);
}

/** Shows a problem until its source says that it is solved. */
function complain(source, problem) {
  if (!(problem instanceof Problem)) throw problem;
  if (problem.status === 401)
    return askToken(hasToken() ? "The server does not know this token." : "");
  const before = problems.get(source);
  problems.set(source, problem);
  if (before?.message !== problem.message) showProblems();  // or it would be read out once more
}

function solve(source) {
  if (problems.delete(source)) showProblems();
}

async function attempt(source, action) {
  try {
    await action();
    solve(source);
  } catch (error) {
    complain(source, error);
  }
}

function tell(text) {
  byId("news").textContent = text;
}

function showBusy(text, share) {
  byId("busy").hidden = text === null;
  byId("busy-text").textContent = text;
  if (share === undefined) byId("busy-bar").removeAttribute("value");
  else byId("busy-bar").value = share;
}

function askToken(error = "") {
  byId("token-error").textContent = error;
  if (!byId("token-dialog").open) byId("token-dialog").showModal();
}

/** False: no other picture than the one that is there, or on its way, is wished for. */
function wish() {
  showValues(sharp);
  if (view?.isClosed) {
    reopen();
    return false;
  }
  const isNew = Boolean(view?.put(optionsOf({view, camera, sharp})));
  if (isNew) showState("rendering");
  return isNew;
}

// ---- The camera ----

function move(change) {
  if (!view) return;
  camera = change(camera ?? placedCamera(view));
  controls.camera.value = "free";
  controls.fov.value = camera.fov;
  wish();
}

function useCamera(index) {
  controls.camera.value = index;
  camera = null;
  controls.fov.value = placedCamera(view).fov;
  wish();
}

function fit() {
  const [width, height] = wishSize();
  if (!view?.asset.is_empty) move((from) => fitted(from, view.asset, width / height));
}

// ---- Images ----

/** The wish's size, unless this is still a picture of an earlier one of another shape. */
function sizeFor({width, height}) {
  const [wide, high] = wishSize();
  const isSameShape = Math.abs(width * high / wide - height) <= 1 + height / width;
  return isSameShape ? [wide, high] : [width, height];
}

function showState(text) {
  if (byId("state").textContent === text) return;
  byId("state").textContent = text;
  const layer = form.querySelector("[name=integrator]:checked")?.title ?? "";
  const state = text.startsWith("refining") ? "refining" : text;
  canvas.setAttribute("aria-label", `${view.asset.name}, ${layer}, ${state}`);
}

function showProgress({samples, of, done, denoised, seconds}, [width, height]) {
  showState(done ? (denoised ? "done, denoised" : "done") : `refining ${samples}/${of}`);
  byId("samples").textContent = `${samples} sample${samples === 1 ? "" : "s"}`;
  byId("seconds").textContent = `${seconds.toFixed(2)} s`;
  byId("size-shown").textContent = `${width} × ${height}`;
}

function onImage(picture) {
  const size = sizeFor(picture);
  draw(canvas, picture, size);
  byId("frame").style.setProperty("--aspect", size[0] / size[1]);
  stage.classList.add("has-picture");
  showProgress(picture, size);
  if (picked && matteWish !== picture.wish) {
    wipe(byId("matte"));
    if (picture.width === size[0] && !view.isBehind) showMatte();
  }
  advance();
}

// ---- Objects ----

function showMatte() {
  matteWish = view.shown;
  const [node, wanted] = [picked, matteWish];
  return attempt("matte", async () => {
    const matte = await view.matte(node);
    if (node === picked && wanted === matteWish) tint(byId("matte"), matte, matteColor);
  });
}

function showPicked(node, more = "") {
  picked = node;
  byId("picked").hidden = node === null;
  byId("picked-node").textContent = node;
  byId("picked-more").textContent = more;
  wipe(byId("matte"));
  for (const button of byId("nodes").querySelectorAll("button")) {
    button.setAttribute("aria-pressed", button.textContent === node);
  }
  if (node !== null) showMatte();
}

async function pickObject(x, y) {
  const hit = await view.pick(x, y);
  showPicked(hit.node, hit.node && `${hit.material ?? ""} · ${hit.distance_m.toPrecision(4)} m`);
  if (!hit.node) tell("Nothing is there");
}

async function pickFocus(x, y) {
  const [width, height] = wishSize();
  const place = currentPlace(camera);
  const pose = currentPose(view);
  const hit = await view.pick(x, y);
  if (!hit.node) return tell("Nothing is there to focus on");
  const pixel = `${Math.floor(x * width)},${Math.floor(y * height)}`;
  sharp = {pixel, size: `${width}x${height}`, place, pose, point: hit.point};
  controls.focus.value = "";
  controls.fstop.value ||= "2.8";
  tell(`Focus on ${hit.node}`);
  wish();
}

/** What was clicked comes to the middle, as large as it is. */
async function pickTarget(x, y) {
  const hit = await view.pick(x, y);
  if (hit.node) move((from) => ({...from, target: hit.point, distance: hit.distance_m}));
}

function click(x, y) {
  const pick = {object: pickObject, focus: pickFocus}[toolChosen()];
  if (view && pick) attempt("pick", () => pick(x, y));
}

function toolChosen() {
  return document.querySelector("[name=tool]:checked").value;
}

function showNodes() {
  const search = byId("search").value.toLowerCase();
  const found = view.asset.nodes.filter((node) => node.toLowerCase().includes(search));
  byId("nodes").replaceChildren(...found.slice(0, mostNodes).map((node) => {
    const item = element("li", "");
    const button = element("button", node, {type: "button", onclick: () => showPicked(node)});
    button.setAttribute("aria-pressed", node === picked);
    item.append(button);
    return item;
  }));
  const rest = found.length - mostNodes;
  byId("more-nodes").textContent = rest > 0 ? `and ${rest} more: search for them` : "";
}

// ---- Animation ----

function play(isOn) {
  playStart = isOn ? performance.now() - 1000 * controls.time.value : null;
  byId("play").setAttribute("aria-pressed", isOn);
  byId("play").textContent = isOn ? "Pause" : "Play";
  if (isOn) step();
}

function step() {
  controls.time.value = (performance.now() - playStart) / 1000 % controls.time.max;
  if (!wish()) setTimeout(advance, 20);  // no picture comes that would go on
}

/** At rest time means nothing: whoever moves it wants to see the first animation. */
function leaveRest() {
  controls.animation.value ||= "0";
}

function togglePlay() {
  leaveRest();
  play(playStart === null);
}

/** The next moment once the last one is seen, however long that takes. */
function advance() {
  if (playStart !== null && !view.isBehind) step();
}

function chooseAnimation() {
  play(false);
  const chosen = view.asset.animations[controls.animation.value || 0];
  controls.time.max = chosen?.end_s || 1;
  controls.time.value = 0;
}

// ---- Opening ----

function onProblem(source, problem) {
  if (!problem) return solve(source);
  complain(source, problem);
  showState("not rendered");
}

const listener = {
  onImage,
  onCommand: (command) => { byId("command").value = command; },
  onProblem,
  onGone: () => {
    if (performance.now() - reopenedAt > longEnoughMs) return reopen();
    const text = "The server has closed this view, as others are open; a change opens it again.";
    complain("open", new Problem(404, {id: "closed", text}));
    showState("not rendered");
  },
};

/** Where more views are open than the server keeps, they would else close each other for ever. */
const longEnoughMs = 15000;
let reopenedAt = -Infinity;

function reopen() {
  reopenedAt = performance.now();
  return openFile(view.file, {isAgain: true});
}

/** Of models that are chosen while others are on their way, the last one wins. */
let lastOpening = 0;

/** Opens a file; again, with the view as it is, when the server has forgotten it. */
async function openFile(file, {isAgain = false, opening = ++lastOpening} = {}) {
  if (opening !== lastOpening) return;
  showBusy(`Reading ${file.split("/").pop()}…`);
  await attempt("open", async () => {
    const opened = await View.open(file, listener);
    if (opening !== lastOpening) return opened.close();
    view?.close();
    view = opened;
    rememberFile(file);
    if (!isAgain) showOpened();
    wish();
  });
  if (opening === lastOpening) showBusy(null);
}

function openFromList(file) {
  byId("open-dialog").close();
  return openFile(file);
}

function showOpened() {
  showAsset(view.asset);
  camera = null;
  sharp = null;
  controls.focus.value = "";
  controls.fov.value = view.camera.fov;
  chooseAnimation();
  showPicked(null);
  showNodes();
  canvas.focus({focusVisible: false});
}

async function take(file) {
  const isEnvironment = /\.(hdr|exr)$/i.test(file.name);
  if (!isEnvironment && !/\.(glb|gltf)$/i.test(file.name)) {
    const text = "this is neither a model (.glb, .gltf) nor an environment (.hdr, .exr)";
    throw new Problem(415, {id: "not opened", place: file.name, text});
  }
  byId("open-dialog").close();
  const opening = isEnvironment ? lastOpening : ++lastOpening;
  const show = (...busy) => { if (opening === lastOpening) showBusy(...busy); };
  const onProgress = (share) => show(`Sending ${file.name}…`, share);
  onProgress(0);
  const sent = await upload(file, onProgress).finally(() => show(null));
  if (!isEnvironment) return openFile(sent, {opening});
  listEnvironment(sent, file.name);
  controls.env.value = sent;
  wish();
}

async function takeAll(files) {
  for (const file of files) await attempt("upload", () => take(file));
}

// ---- Saving ----

function save(format) {
  if (!view) return;
  attempt("save", async () => {
    const name = `${view.asset.name.replace(/\.[^.]*$/, "")}.${format}`;
    const href = URL.createObjectURL(await view.image(format));
    element("a", "", {href, download: name}).click();
    setTimeout(() => URL.revokeObjectURL(href), 60000);
    tell(`Saved ${name}`);
  });
}

async function copyCommand() {
  const {value} = byId("command");
  if (!value) return;
  try {
    await navigator.clipboard.writeText(value);
  } catch {  // without permission, or served from another machine without TLS
    byId("command").select();
    document.execCommand("copy");
  }
  tell("Command copied");
}

// ---- Hands ----

/** What a change of these does beside a new wish. */
const effects = {
  camera: () => useCamera(controls.camera.value),
  fov: () => move((from) => ({...from, fov: Number(controls.fov.value)})),
  focus: () => { sharp = null; },
  display: showTones,
  animation: chooseAnimation,
  time: () => { leaveRest(); play(false); },
};

function layerKey(index) {
  form.querySelectorAll("[name=integrator]")[index]?.click();
}

const keys = {
  r: () => view && useCamera(""),
  home: () => view && useCamera(""),
  f: fit,
  o: () => byId("open-dialog").showModal(),
  s: () => save("png"),
  e: () => save("exr"),
  c: copyCommand,
  d: () => controls.denoise.click(),
  escape: () => view && showPicked(null),
  "?": () => byId("help-dialog").showModal(),
};

function onKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const change = moveOfKey(event.key, event.shiftKey);
  const action = keys[event.key.toLowerCase()];
  if (change) move(change);
  else if (action) action();
  else if (/^[1-5]$/.test(event.key)) layerKey(event.key - 1);
  else return;
  event.preventDefault();
}

function watchDrops() {
  const mark = (isOver) => document.body.classList.toggle("dropping", isOver);
  addEventListener("dragover", (event) => { event.preventDefault(); mark(true); });
  addEventListener("dragleave", (event) => { if (!event.relatedTarget) mark(false); });
  addEventListener("drop", (event) => {
    event.preventDefault();
    mark(false);
    takeAll(event.dataTransfer.files);
  });
}

function watchButtons() {
  const clicks = {
    open: keys.o, help: keys["?"], copy: copyCommand, reset: keys.r, fit,
    "save-png": keys.s, "save-exr": keys.e, unpick: keys.escape,
    play: togglePlay,
  };
  for (const [id, action] of Object.entries(clicks)) byId(id).addEventListener("click", action);
  byId("drawer").addEventListener("click", () => {
    const isOpen = document.body.classList.toggle("drawer-open");
    byId("drawer").setAttribute("aria-expanded", isOpen);
  });
  byId("search").addEventListener("input", () => view && showNodes());
  byId("upload").addEventListener("change", ({target}) => {
    takeAll([...target.files]);
    target.value = "";  // so that the same file may be chosen again
  });
}

function watch() {
  form.addEventListener("submit", (event) => event.preventDefault());
  form.addEventListener("input", (event) => {
    if (!event.target.name) return;
    effects[event.target.name]?.();
    wish();
  });
  watchButtons();
  watchDrops();
  canvas.addEventListener("keydown", onKey);
  watchPointers(canvas, {
    move, click,
    doubleClick: (x, y) => view && attempt("pick", () => pickTarget(x, y)),
  });
  let settled;
  new ResizeObserver(() => {
    clearTimeout(settled);
    settled = setTimeout(wish, 150);  // a window that is dragged does not restart each time
  }).observe(stage);
}

// ---- Beginning ----

function start(file) {
  return attempt("start", async () => {
    showChoices(await callJson("choices"));
    showFiles((await callJson("files")).files, openFromList);
    showValues(sharp);
    if (file) await openFile(file);
    else byId("open-dialog").showModal();
  });
}

const wanted = takeFragment();
addEventListener("hashchange", () => {  // the printed address, in a tab that has the page already
  takeFragment();
  location.reload();
});
byId("token-dialog").addEventListener("cancel", (event) => event.preventDefault());
byId("token-form").addEventListener("submit", (event) => {
  event.preventDefault();
  setToken(byId("token").value.trim());
  byId("token-dialog").close();
  if (!view) start(wanted);  // or the open view asks on by itself
});
watch();
start(wanted);
