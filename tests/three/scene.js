// What runs in the browser: a scene as three.js' GLTFLoader reads it, seen from near. The driver is scenes.mjs.

import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';

const SIZE = 256;
const renderer = new THREE.WebGLRenderer({ antialias: false });
const environment = new THREE.PMREMGenerator(renderer).fromScene(new RoomEnvironment()).texture;

/** Pixels of a scene (codes of sRGB), what the loader said of it, and what it kept of the tables. */
window.view = async (url) => {
    const said = [];
    const { warn, error } = console;
    console.warn = (...words) => said.push(`warning: ${words.join(' ')}`);
    console.error = (...words) => said.push(`error: ${words.join(' ')}`);
    try {
        const { scene: model, userData } = await new GLTFLoader().loadAsync(url);
        const scene = new THREE.Scene();
        scene.environment = environment;
        scene.background = new THREE.Color(0.2, 0.2, 0.2);
        scene.add(model);
        const box = new THREE.Box3().setFromObject(model);
        const [centre, size] = [box.getCenter(new THREE.Vector3()), box.getSize(new THREE.Vector3()).length() || 1];
        const camera = new THREE.PerspectiveCamera(40, 1, size / 100, size * 10);
        camera.position.copy(centre).add(new THREE.Vector3(0.3, 0.4, 1).normalize().multiplyScalar(size));
        camera.lookAt(centre);
        const target = new THREE.WebGLRenderTarget(SIZE, SIZE, { colorSpace: THREE.SRGBColorSpace });
        renderer.setRenderTarget(target);
        renderer.render(scene, camera);
        const pixels = new Uint8Array(4 * SIZE * SIZE);
        renderer.readRenderTargetPixels(target, 0, 0, SIZE, SIZE, pixels);
        renderer.setRenderTarget(null);
        target.dispose();
        const tables = userData.gltfExtensions?.BRDFBAKE_lookup_tables?.tables?.length ?? 0;
        return { pixels: Array.from(pixels), said, tables };
    } finally {
        Object.assign(console, { warn, error });
    }
};

window.ready = true;
