'use strict';
// Names the texel under the pointer, or under a cursor that the arrow keys move.
for (const table of document.querySelectorAll('.table')) {
  const maps = table.querySelector('.maps');
  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
  const floats = (text) => new Float32Array(bytes(text));
  const short = (text) => new Float32Array(Uint32Array.from(new Uint16Array(bytes(text)), (v) => v << 16).buffer);
  const [width, height] = maps.dataset.size.split(',').map(Number);
  const step = maps.dataset.step.split(',').map(Number);
  const channels = JSON.parse(maps.dataset.channels);
  const axes = JSON.parse(maps.dataset.axes).map(([id, dims, values]) => ({ id, dims, values: floats(values) }));
  const values = floats(maps.dataset.values);
  // a map says of its texels what it is off by in a channel of its own
  const [estimates, off] = ['estimates', 'off'].map((key) => (maps.dataset[key] === undefined ? undefined : short(maps.dataset[key])));
  const read = maps.querySelector('.read');
  const pictures = [...maps.querySelectorAll('.map')];
  const slices = 1 + Math.max(...pictures.map((m) => Number(m.dataset.slice)));
  const length = { x: width, y: height, s: slices };
  const digits = (v, n) => (Number.isFinite(v) ? String(Number(v.toPrecision(n))) : 'not known');
  let at = { s: 0, x: 0, y: 0 };

  const show = (place) => {
    at = place;
    const axis = ({ id, dims, values: all }) => `${id} = ${digits(all[[...dims].reduce((n, d) => n * length[d] + at[d], 0)], 6)}`;
    const first = ((at.s * height + at.y) * width + at.x) * channels.length;
    const channel = (id, i) => {
      if (!estimates) return `${id} = ${digits(values[first + i], 4)}`;
      const known = Number.isFinite(estimates[first + i]);
      const error = known ? ` (estimate ${digits(estimates[first + i], 2)}, stored off by ${digits(off[first + i], 2)})` : ' (error not known)';
      return `${id} = ${digits(values[first + i], 6)}${error}`;
    };
    read.textContent = `Texel ${at.x * step[0]}, ${at.y * step[1]}: ${axes.map(axis).join(', ')}: ${channels.map(channel).join('; ')}`;
    for (const map of pictures) {
      let cross = map.querySelector('.cross');
      if (Number(map.dataset.slice) !== at.s) {
        cross?.remove();
        continue;
      }
      if (!cross) {
        cross = document.createElement('div');
        cross.className = 'cross';
        map.append(cross);
      }
      Object.assign(cross.style, { left: `${(100 * at.x) / width}%`, top: `${(100 * at.y) / height}%`, width: `${100 / width}%`, height: `${100 / height}%` });
    }
  };

  const clamp = (v, n) => Math.min(Math.max(v, 0), n - 1);
  for (const map of pictures) {
    const s = Number(map.dataset.slice);
    map.addEventListener('pointermove', (event) => {
      const box = map.getBoundingClientRect();
      const place = (from, size, n) => clamp(Math.floor((from / size) * n), n);
      show({ s, x: place(event.clientX - box.left, box.width, width), y: place(event.clientY - box.top, box.height, height) });
    });
    map.addEventListener('keydown', (event) => {
      const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
      if (!by) return;
      event.preventDefault();
      show({ s, x: clamp(at.x + by[0], width), y: clamp(at.y + by[1], height) });
    });
    map.addEventListener('focus', () => show({ ...at, s }));
  }
  for (const button of table.querySelectorAll('button[data-at]')) {
    const [s, x, y] = button.dataset.at.split(',').map(Number);
    button.hidden = false;
    button.addEventListener('click', () => {
      show({ s, x, y });
      maps.scrollIntoView({ block: 'start' });
    });
  }
}
