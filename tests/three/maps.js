// What runs in the browser: a scene with its own textures or with filtered maps, under a light that stands where the eye is. The driver
// is maps.mjs.

import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { BrdfbakeMaps } from '/plugin.js';

const renderer = new THREE.WebGLRenderer({ antialias: false });

/** The scene of a file, through the plugin or not. */
async function load(url, plugin) {
    const loader = new GLTFLoader();
    if (plugin) loader.register((parser) => new BrdfbakeMaps(parser));
    return (await loader.loadAsync(url)).scene;
}

/** Linear radiance of the pixels of a view: `size` of them a side, `zoom` times as near as a view of the whole sphere. */
function draw(model, size, zoom) {
    const scene = new THREE.Scene();
    scene.add(model);
    const camera = new THREE.PerspectiveCamera(20 / zoom, 1, 0.1, 100);
    const light = new THREE.DirectionalLight(0xffffff, 0.35);
    camera.position.set(0, 0, 7);
    light.position.copy(camera.position);
    scene.add(light, camera);
    model.rotation.y = 0.35;
    camera.lookAt(0, 0, 0);
    const target = new THREE.WebGLRenderTarget(size, size, { type: THREE.FloatType, colorSpace: THREE.LinearSRGBColorSpace });
    renderer.setRenderTarget(target);
    renderer.render(scene, camera);
    const pixels = new Float32Array(4 * size * size);
    renderer.readRenderTargetPixels(target, 0, 0, size, size, pixels);
    renderer.setRenderTarget(null);
    target.dispose();
    scene.remove(model);
    return pixels.filter((_, i) => i % 4 === 0);
}

/** Means of squares of `n` x `n` pixels. */
function shrink(pixels, size, n) {
    const out = new Float32Array(size * size);
    const side = size * n;
    for (let y = 0; y < side; y++) {
        for (let x = 0; x < side; x++) out[Math.floor(y / n) * size + Math.floor(x / n)] += pixels[y * side + x] / (n * n);
    }
    return out;
}

const numbers = (pixels) => Array.from(pixels);

/** The same view thrice: with the textures of the engine, with the maps, and of the largest levels alone at n x n times the pixels. */
window.compare = async (old, written, size, zoom, n) => {
    const [plain, mapped] = [await load(old, false), await load(written, true)];
    const engine = draw(plain, size, zoom);
    const maps = draw(mapped, size, zoom);
    plain.traverse(({ material }) => {
        for (const map of [material?.normalMap, material?.roughnessMap, material?.metalnessMap]) {
            if (map) Object.assign(map, { minFilter: THREE.LinearFilter, needsUpdate: true });
        }
    });
    const truth = shrink(draw(plain, size * n, zoom), size, n);
    return { engine: numbers(engine), maps: numbers(maps), truth: numbers(truth) };
};

window.ready = true;
