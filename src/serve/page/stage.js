// serve/page/stage.js - the picture and the hands on it: drawing, the orbit camera, gestures.
// SPDX-License-Identifier: Apache-2.0

const {sin, cos, tan, atan2, asin, sqrt, exp, min, max, PI} = Math;
const radians = PI / 180;
const steepest = 89.9 * radians;

const add = (a, b) => a.map((x, i) => x + b[i]);
const scaled = (a, s) => a.map((x) => x * s);
const minus = (a, b) => add(a, scaled(b, -1));
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const length = (a) => sqrt(dot(a, a));
const clamped = (x, low, high) => min(max(x, low), high);

// ---- The orbit camera: {target, distance, azimuth, elevation, fov}, never changed in place ----

/** From the target to the eye. */
function backward({azimuth, elevation}) {
  return [cos(elevation) * sin(azimuth), sin(elevation), cos(elevation) * cos(azimuth)];
}

export function eyeOf(camera) {
  return add(camera.target, scaled(backward(camera), camera.distance));
}

/** Metres to a point along the view axis, as a lens is focused. */
export function depthOf(camera, point) {
  return dot(minus(eyeOf(camera), point), backward(camera));
}

export function cameraAt({eye, target, fov}) {
  const back = minus(eye, target);
  const distance = length(back);
  return {
    target, distance, fov,
    azimuth: atan2(back[0], back[2]),
    elevation: clamped(asin(clamped(back[1] / distance, -1, 1)), -steepest, steepest),
  };
}

/** A camera of the file, which has no target: one is put beside the middle of all there is. */
export function cameraAlong({eye, forward, fov}, {low, high}) {
  const ahead = dot(minus(scaled(add(low, high), 0.5), eye), forward);
  const distance = max(ahead, length(minus(high, low)) * 0.05);
  return cameraAt({eye, target: add(eye, scaled(forward, distance)), fov: fov ?? 35});
}

export function orbited(camera, azimuth, elevation) {
  return {
    ...camera,
    azimuth: camera.azimuth + azimuth,
    elevation: clamped(camera.elevation + elevation, -steepest, steepest),
  };
}

/** Moves the picture by shares of its height, to the right and down. */
function panned(camera, dx, dy) {
  const {azimuth, elevation, distance} = camera;
  const right = [cos(azimuth), 0, -sin(azimuth)];
  const up = [-sin(elevation) * sin(azimuth), cos(elevation), -sin(elevation) * cos(azimuth)];
  const height = 2 * distance * tan(camera.fov * radians / 2);
  const move = add(scaled(right, -dx * height), scaled(up, dy * height));
  return {...camera, target: add(camera.target, move)};
}

function dollied(camera, factor) {
  return {...camera, distance: max(camera.distance * factor, 1e-5)};
}

/** Looks at all of a box from where the camera is, whatever the picture's shape. */
export function fitted(camera, {low, high}, aspect) {
  const half = atan2(tan(camera.fov * radians / 2) * min(aspect, 1), 1);
  const radius = max(length(minus(high, low)) / 2, 1e-5);
  return {...camera, target: scaled(add(low, high), 0.5), distance: radius / sin(half)};
}

// ---- Drawing ----

/** Pixels of 1, 3 or 4 channels as those of a canvas. */
function rgbaOf({width, height, channels, bytes}) {
  const image = new ImageData(width, height);
  if (channels === 4) {
    image.data.set(bytes);
    return image;
  }
  const words = new Uint32Array(image.data.buffer);  // a pixel at once takes a third of the time
  const [green, blue] = channels === 3 ? [1, 2] : [0, 0];
  for (let i = 0, j = 0; i < words.length; i++, j += channels) {
    words[i] = 0xff000000 | bytes[j + blue] << 16 | bytes[j + green] << 8 | bytes[j];
  }
  return image;
}

const scratch = document.createElement("canvas");

/** Draws a picture over a canvas of the wish's size; small ones of a moving view are scaled up. */
export function draw(canvas, picture, [width, height]) {
  const context = canvas.getContext("2d");
  if (canvas.width !== width) canvas.width = width;
  if (canvas.height !== height) canvas.height = height;
  if (picture.width === width && picture.height === height) {
    context.putImageData(rgbaOf(picture), 0, 0);
    return;
  }
  scratch.width = picture.width;
  scratch.height = picture.height;
  scratch.getContext("2d").putImageData(rgbaOf(picture), 0, 0);
  context.imageSmoothingQuality = "high";
  context.clearRect(0, 0, width, height);
  context.drawImage(scratch, 0, 0, width, height);
}

/** Lays a matte over the picture as a tint. */
export function tint(canvas, {width, height, bytes}, [red, green, blue]) {
  const image = new ImageData(width, height);
  const words = new Uint32Array(image.data.buffer);
  const color = blue << 16 | green << 8 | red;
  for (let i = 0; i < words.length; i++) words[i] = bytes[i] * 0.45 << 24 | color;
  canvas.width = width;
  canvas.height = height;
  canvas.getContext("2d").putImageData(image, 0, 0);
}

export function wipe(canvas) {
  canvas.getContext("2d").clearRect(0, 0, canvas.width, canvas.height);
}

// ---- Gestures. `move` takes a function from camera to camera. ----

const clickPx = 5;
const doubleMs = 350;
const keyAngle = 5 * radians;
const keyPan = 0.05;
const keyDolly = 0.9;

/** Where on the picture an event is, in shares of its width and height. */
function shareOf(canvas, event) {
  const box = canvas.getBoundingClientRect();
  return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
}

function spread(fingers) {
  const [a, b] = fingers;
  return {x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, apart: max(Math.hypot(a.x - b.x, a.y - b.y), 1)};
}

/** Drags, pinches, clicks and the wheel: calls move(change), click(x, y) and doubleClick(x, y). */
export function watchPointers(canvas, {move, click, doubleClick}) {
  const fingers = new Map();
  let travelled = 0;
  let lastClick = {time: -Infinity};

  function drag(dx, dy, isPan) {
    const height = canvas.clientHeight;
    if (isPan) move((camera) => panned(camera, dx / height, dy / height));
    else move((camera) => orbited(camera, -dx * PI / height, dy * PI / height));
  }

  function pinch(before, after) {
    drag(after.x - before.x, after.y - before.y, true);
    move((camera) => dollied(camera, before.apart / after.apart));
  }

  function onMove(event) {
    const finger = fingers.get(event.pointerId);
    if (!finger) return;
    const before = fingers.size === 2 && spread([...fingers.values()]);
    const [dx, dy] = [event.clientX - finger.x, event.clientY - finger.y];
    Object.assign(finger, {x: event.clientX, y: event.clientY});
    travelled += Math.abs(dx) + Math.abs(dy);
    if (travelled < clickPx) return;
    if (before) pinch(before, spread([...fingers.values()]));
    else if (fingers.size === 1) drag(dx, dy, finger.isPan || event.shiftKey);
  }

  function onUp(event) {
    const finger = fingers.get(event.pointerId);
    fingers.delete(event.pointerId);
    if (!finger || finger.isPan || fingers.size || travelled >= clickPx) return;
    const at = shareOf(canvas, event);
    const isDouble = event.timeStamp - lastClick.time < doubleMs &&
        Math.hypot(event.clientX - lastClick.x, event.clientY - lastClick.y) < 4 * clickPx;
    lastClick = isDouble ? {time: -Infinity}
      : {time: event.timeStamp, x: event.clientX, y: event.clientY};
    (isDouble ? doubleClick : click)(...at);
  }

  canvas.addEventListener("pointerdown", (event) => {
    travelled = fingers.size ? Infinity : 0;  // two fingers never click
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, {x: event.clientX, y: event.clientY, isPan: event.button > 0});
  });
  canvas.addEventListener("pointermove", onMove);
  canvas.addEventListener("pointerup", onUp);
  canvas.addEventListener("pointercancel", (event) => fingers.delete(event.pointerId));
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const px = event.deltaY * (event.deltaMode === 1 ? 16 : 1) * (event.ctrlKey ? 8 : 1);
    move((camera) => dollied(camera, exp(clamped(px, -300, 300) * 0.0012)));
  }, {passive: false});
}

/** How a key moves the camera, or undefined. */
export function moveOfKey(key, isShift) {
  const arrow = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[key];
  if (arrow && isShift) {
    return (camera) => panned(camera, -arrow[0] * keyPan, -arrow[1] * keyPan);
  }
  if (arrow) {
    return (camera) => orbited(camera, arrow[0] * keyAngle, -arrow[1] * keyAngle);
  }
  if (key === "+" || key === "=") return (camera) => dollied(camera, keyDolly);
  if (key === "-" || key === "_") return (camera) => dollied(camera, 1 / keyDolly);
  return undefined;
}
