// The pictures that error measures are checked with, pixel by pixel in integers; the same as
// tests/unit/client/measure/sample_pictures.hpp.
export const width = 96;
export const height = 72;

const clamp = (value) => Math.max(0, Math.min(255, value));

function hash(x, y, salt) {
  let h = Math.imul(x, 374761393) + Math.imul(y, 668265263) + Math.imul(salt, -2024723777);
  h = Math.imul(h ^ (h >>> 13), 1274126177);
  return (h ^ (h >>> 16)) >>> 0;
}

// Checks and ramps with a disc on them and a little noise.
function base(x, y) {
  const check = ((x >> 3) + (y >> 3)) % 2;
  const disc = (x - 60) ** 2 + (y - 30) ** 2 < 400;
  const noise = hash(x, y, 1) % 16;
  const red = disc ? 220 : 2 * x + 30 * check;
  const green = disc ? 90 : 3 * y + 20 * check;
  const blue = disc ? 40 + x : 200 - x - y + 10 * check;
  return [red, green, blue].map((value) => clamp(value + noise));
}

export const samples = {
  base,
  noise: (x, y) => base(x, y).map((value, c) => clamp(value + (hash(x, y, 2 + c) % 61) - 30)),
  shift: (x, y) => base(x + 2, y),
  dots: (x, y) => (hash(x, y, 7) % 20 === 0 ? [24, 26, 30] : base(x, y)),
  tint: (x, y) => base(x, y).map((value, c) => clamp(value + [-20, 0, 40][c])),
};

// As ImageData; grey: the mean of the channels, rounded down.
export function picture(name, grey) {
  const data = [];
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const [r, g, b] = samples[name](x, y);
      const mean = Math.floor((r + g + b) / 3);
      data.push(...(grey ? [mean, mean, mean] : [r, g, b]), 255);
    }
  return { width, height, data: Uint8ClampedArray.from(data) };
}
