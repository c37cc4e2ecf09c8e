import { check } from './error.js';
import { native } from './library.js';
import { copyOf, NativeObject } from './object.js';
import { fill, report } from './struct.js';
import { index, rows } from './values.js';

/** The tetrahedral mesh of a body at rest. */
export class Mesh extends NativeObject {
  static #make(create) {
    const out = [null];
    check(create(out));
    return new Mesh(out[0], native.crumble_mesh_destroy);
  }

  static create(def) {
    const filled = fill('crumble_mesh_def', def);
    return Mesh.#make((out) => native.crumble_mesh_create(filled, out));
  }

  static createPaper(body) {
    return Mesh.#make((out) => native.crumble_mesh_create_paper(index('body', body), out));
  }

  static createFromTets(positions, tetrahedra) {
    const points = rows('positions', positions, 3);
    const tets = rows('tetrahedra', tetrahedra, 4, Uint32Array);
    return Mesh.#make((out) =>
      native.crumble_mesh_create_from_tets(points, points.length / 3, tets, tets.length / 4, out),
    );
  }

  getInfo() {
    return report('crumble_mesh_info', (info) => native.crumble_mesh_get_info(this.handle, info));
  }

  saveVtk(path) {
    check(native.crumble_mesh_save_vtk(this.handle, path));
  }

  getView(which) {
    index('which', which);
    return this.view(which, (view) => native.crumble_mesh_get_view(this.handle, which, view));
  }

  copy(which) {
    return copyOf(which, (dst, bytes, needed) => native.crumble_mesh_copy(this.handle, which, dst, bytes, needed));
  }
}
