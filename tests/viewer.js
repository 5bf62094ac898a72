// What the tests ask of three.js and three-vrm, in a page.
import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { RoomEnvironment } from "three/addons/environments/RoomEnvironment.js";
import { VRMLoaderPlugin, VRMMetaLoaderPlugin } from "@pixiv/three-vrm";

const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
renderer.setSize(innerWidth, innerHeight);
renderer.toneMapping = THREE.ACESFilmicToneMapping;
document.body.append(renderer.domElement);
const scene = new THREE.Scene();
scene.background = new THREE.Color(0x40454a);
const room = new THREE.PMREMGenerator(renderer);
scene.environment = room.fromScene(new RoomEnvironment(), 0.04).texture;
scene.environmentIntensity = 0.55;
const key = new THREE.DirectionalLight(0xfff0e0, 2.2);
key.position.set(-0.5, 0.6, 0.85);
scene.add(key, new THREE.DirectionalLight(0xdde8ff, 0.5).translateX(0.8).translateZ(0.3));
const camera = new THREE.PerspectiveCamera(22, innerWidth / innerHeight, 0.05, 20);
let loaded, mixer, vrm;

function named(name) {
  return loaded.scene.getObjectByName(name);
}

// Loads a file, and tells what it is made of.
window.load = async (url) => {
  const loader = new GLTFLoader();
  loader.register((parser) => new VRMLoaderPlugin(parser, { metaPlugin: new VRMMetaLoaderPlugin(parser, { needThumbnailImage: true }) }));
  if (loaded) scene.remove(loaded.scene);
  loaded = await loader.loadAsync(url);
  vrm = loaded.userData.vrm;
  scene.add(loaded.scene);
  mixer = loaded.animations.length ? new THREE.AnimationMixer(loaded.scene) : null;
  if (mixer) mixer.clipAction(loaded.animations[0]).setLoop(THREE.LoopOnce).play().clampWhenFinished = true;
  loaded.scene.traverse((node) => (node.frustumCulled = false));
  const meshes = {};
  loaded.scene.traverse((node) => {
    if (node.isMesh) meshes[node.name] = { vertices: node.geometry.attributes.position.count, shapes: Object.keys(node.morphTargetDictionary ?? {}) };
  });
  return { meshes, duration: loaded.animations[0]?.duration ?? 0, joints: vrm ? Object.keys(vrm.humanoid.humanBones) : [],
    expressions: vrm ? vrm.expressionManager.expressions.map((one) => one.expressionName) : [], meta: vrm ? { ...vrm.meta, thumbnailImage: Boolean(vrm.meta.thumbnailImage) } : null };
};

// Sets weights of shapes by name, in all meshes that have them.
window.shape = (weights) => {
  loaded.scene.traverse((node) => {
    if (!node.morphTargetDictionary) return;
    node.morphTargetInfluences.fill(0);
    for (const [name, value] of Object.entries(weights)) {
      if (name in node.morphTargetDictionary) node.morphTargetInfluences[node.morphTargetDictionary[name]] = value;
    }
  });
};

window.seek = (time) => { mixer.setTime(time); };  // the mixer itself is not to be returned: all of it would be sent

window.scene_of = named;

// Poses an avatar: expressions, the point that it looks at, and bones by their angles.
window.pose = ({ expressions = {}, gaze = null, bones = {} }) => {
  for (const one of vrm.expressionManager.expressions) vrm.expressionManager.setValue(one.expressionName, expressions[one.expressionName] ?? 0);
  for (const name of Object.keys(vrm.humanoid.humanBones)) {
    vrm.humanoid.getNormalizedBoneNode(name)?.rotation.set(...(bones[name] ?? [0, 0, 0]));
  }
  const target = new THREE.Object3D();
  vrm.lookAt.autoUpdate = true;
  vrm.lookAt.target = gaze ? target : null;
  if (gaze) target.position.set(...gaze);
  else vrm.lookAt.reset?.();
  if (!gaze) { vrm.lookAt.yaw = 0; vrm.lookAt.pitch = 0; }
  target.updateMatrixWorld(true);
  vrm.update(1 / 60);
};

// The places of a mesh's vertices in the scene, as shown: x, y, z, x, ... in double precision and base 64, as lists of numbers take long.
window.places = (name) => {
  loaded.scene.updateMatrixWorld(true);
  const mesh = named(name), point = new THREE.Vector3(), found = new Float64Array(3 * mesh.geometry.attributes.position.count);
  mesh.skeleton?.update();
  for (let i = 0; i < found.length / 3; i++) {
    mesh.getVertexPosition(i, point).applyMatrix4(mesh.matrixWorld).toArray(found, 3 * i);
  }
  const bytes = new Uint8Array(found.buffer);
  let text = "";
  for (let i = 0; i < bytes.length; i += 8192) text += String.fromCharCode(...bytes.subarray(i, i + 8192));
  return btoa(text);
};

// Where a mesh's material's picture is not grey: whether there is one, and how large.
window.pictures = () => {
  const found = {};
  loaded.scene.traverse((node) => {
    if (node.isMesh) found[node.name] = node.material.map ? [node.material.map.image.width, node.material.map.image.height] : null;
  });
  return found;
};

window.draw = (eye, target) => {
  camera.position.set(...eye);
  camera.lookAt(...target);
  renderer.render(scene, camera);
};
// What a receiver of VMC does with messages, each its address and its arguments: the names of VRM 0 are those of VRM 1,
// and Unity's axes have x the other way round.
const presets = { Joy: "happy", Angry: "angry", Sorrow: "sad", Fun: "relaxed", Surprised: "surprised", A: "aa", I: "ih", U: "ou", E: "ee",
  O: "oh", Blink: "blink", Blink_L: "blinkLeft", Blink_R: "blinkRight", Neutral: "neutral", LookUp: "lookUp", LookDown: "lookDown",
  LookLeft: "lookLeft", LookRight: "lookRight" };
const received = new Map();
window.receive = (messages) => {
  for (const [address, name, ...numbers] of messages) {
    if (address === "/VMC/Ext/Blend/Val") received.set(presets[name] ?? name, numbers[0]);
    if (address === "/VMC/Ext/Blend/Apply") received.forEach((value, key) => vrm.expressionManager.setValue(key, value));
    if (address === "/VMC/Ext/Bone/Pos") {
      const [x, y, z, w] = numbers.slice(3);
      vrm.humanoid.getNormalizedBoneNode(name[0].toLowerCase() + name.slice(1))?.quaternion.set(x, -y, -z, w);
    }
  }
  vrm.lookAt.target = null;
  vrm.update(1 / 60);
};

// The expressions that an avatar shows, and where some of its bones look, in the scene.
window.avatar = (bones) => {
  loaded.scene.updateMatrixWorld(true);
  const directions = {}, expressions = {};
  for (const name of bones) directions[name] = vrm.humanoid.getRawBoneNode(name).getWorldDirection(new THREE.Vector3()).toArray();
  for (const one of vrm.expressionManager.expressions) {
    const value = vrm.expressionManager.getValue(one.expressionName);
    if (value > 0.001) expressions[one.expressionName] = value;
  }
  return { expressions, directions };
};

window.ready = true;
