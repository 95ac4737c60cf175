// Reads models with other people's readers and compares them with what was written:
//   node verify.mjs DIR       (models and expected.json of make_ifc_models)
// web-ifc: geometry, colours, the spatial tree, property sets. The schema tables of
// web-ifc and @ifc-lite/parser: number of arguments, enumerations, what must be there.
import fs from 'node:fs';
import path from 'node:path';
import * as WebIFC from 'web-ifc';
import { IfcParser, SCHEMA_REGISTRY } from '@ifc-lite/parser';

const folder = process.argv[2];
const say = console.log;
console.log = () => {}; // ifc-lite tells how it gets on
const tolerance = 1e-4; // a tenth of a millimetre
let checks = 0;
const failures = [];

function check(ok, what) {
  ++checks;
  if (!ok) failures.push(what);
}

// ------------------------------------------------- an own small splitter of instances

function split(text) {
  const parts = [];
  let depth = 0, quoted = false, start = 0;
  for (let i = 0; i < text.length; ++i) {
    const c = text[i];
    if (c === "'") quoted = !quoted;
    else if (quoted) continue;
    else if (c === '(') ++depth;
    else if (c === ')') --depth;
    else if (c === ',' && depth === 0) {
      parts.push(text.slice(start, i).trim());
      start = i + 1;
    }
  }
  const last = text.slice(start).trim();
  if (parts.length > 0 || last !== '') parts.push(last);
  return parts;
}

function instances(text) {
  const out = new Map();
  for (const m of text.matchAll(/^#(\d+)=\s*([A-Z0-9]+)\((.*)\)\s*;\s*$/gm))
    out.set(Number(m[1]), { name: m[2], arguments: split(m[3]) });
  return out;
}

const registry = new Map(
  Object.values(SCHEMA_REGISTRY.entities).map((e) => [e.name.toUpperCase(), e]));

function checkSchema(file, text, schema) {
  const toRaw = WebIFC.ToRawLineData[schema === 'IFC2X3' ? 1 : 2];
  const guids = new Set();
  for (const [id, instance] of instances(text)) {
    const where = `${file} #${id}=${instance.name}`;
    const code = WebIFC[instance.name];
    check(code !== undefined && toRaw[code] !== undefined, `${where}: not in ${schema}`);
    if (toRaw[code] === undefined) continue;
    // web-ifc leaves the derived first argument of a unit out
    const arity = toRaw[code]({}).length + (instance.name === 'IFCSIUNIT' ? webIfcUnit : 0);
    check(arity === instance.arguments.length,
          `${where}: ${instance.arguments.length} arguments, expected ${arity}`);
    const entity = registry.get(instance.name);
    if (schema === 'IFC4' && entity) {
      const attributes = entity.allAttributes;
      instance.arguments.forEach((argument, i) => {
        const attribute = attributes[i];
        if (!attribute) return;
        check(argument !== '$' || attribute.optional,
              `${where}: ${attribute.name} must be there`);
        const words = SCHEMA_REGISTRY.enums[attribute.type];
        if (words && /^\..*\.$/.test(argument))
          check(words.includes(argument.slice(1, -1)),
                `${where}: ${argument} is no ${attribute.type}`);
      });
    }
    const inherits = entity?.inheritanceChain ?? [];
    if (inherits.includes('IfcRoot')) {
      const guid = instance.arguments[0].slice(1, -1);
      check(/^[0-3][0-9A-Za-z_$]{21}$/.test(guid), `${where}: ${guid} is no GlobalId`);
      check(!guids.has(guid), `${where}: ${guid} is there twice`);
      guids.add(guid);
    }
  }
}

// -------------------------------------------------------------------------- geometry

const api = new WebIFC.IfcAPI();
await api.Init();
api.SetLogLevel(WebIFC.LogLevel.LOG_LEVEL_OFF);
const webIfcUnit = 4 - WebIFC.ToRawLineData[2][WebIFC.IFCSIUNIT]({}).length;

function corners(model, id) {
  const mesh = api.GetFlatMesh(model, id);
  const points = [], colors = [];
  for (let i = 0; i < mesh.geometries.size(); ++i) {
    const placed = mesh.geometries.get(i);
    colors.push(placed.color);
    const geometry = api.GetGeometry(model, placed.geometryExpressID);
    const vertices = api.GetVertexArray(
      geometry.GetVertexData(), geometry.GetVertexDataSize());
    const m = placed.flatTransformation;
    for (let k = 0; k + 2 < vertices.length; k += 6) {
      const [x, y, z] = [vertices[k], vertices[k + 1], vertices[k + 2]];
      const at = (row) => m[row] * x + m[4 + row] * y + m[8 + row] * z + m[12 + row];
      // web-ifc's y is up: (x, z, -y) of the model
      points.push([at(0), -at(2), at(1)]);
    }
    geometry.delete();
  }
  return { points, colors };
}

function nearest(p, all) {
  return Math.min(...all.map((q) => Math.hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2])));
}

function treeIds(node, out = new Set()) {
  out.add(node.expressID);
  for (const child of node.children ?? []) treeIds(child, out);
  return out;
}

async function checkModel(expected) {
  const file = expected.file;
  const bytes = fs.readFileSync(path.join(folder, file));
  const text = bytes.toString('latin1');
  const schema = text.includes("'IFC2X3'") ? 'IFC2X3' : 'IFC4';
  checkSchema(file, text, schema);

  const model = api.OpenModel(new Uint8Array(bytes));
  check(api.GetModelSchema(model) === schema, `${file}: schema`);
  const byGuid = new Map();
  for (const id of api.GetAllLines(model)) {
    const line = api.GetLine(model, id);
    if (line?.ObjectPlacement !== undefined) byGuid.set(line.GlobalId?.value, id);
  }
  const tree = treeIds(await api.properties.getSpatialStructure(model, false));
  let worst = 0;
  for (const thing of expected.things) {
    const where = `${file} ${thing.entity} ${thing.id}`;
    const id = byGuid.get(thing.id);
    check(id !== undefined, `${where}: not found`);
    if (id === undefined) continue;
    check(tree.has(id), `${where}: not in the spatial tree`);
    const line = api.GetLine(model, id);
    check(line.Name.value === thing.name, `${where}: its name is ${line.Name.value}`);
    const { points, colors } = corners(model, id);
    check(points.length >= 8, `${where}: ${points.length} points`);
    if (points.length < 8) continue;
    for (const p of thing.corners) worst = Math.max(worst, nearest(p, points));
    for (const p of points) worst = Math.max(worst, nearest(p, thing.corners));
    check(worst < tolerance, `${where}: a corner is off by ${worst} m`);
    // the model keeps sRGB; web-ifc hands it on as it is
    const color = colors[0];
    [color.x, color.y, color.z].forEach((c, k) =>
      check(Math.abs(c * 255 - thing.rgb[k]) < 0.01, `${where}: colour ${c * 255}`));
    const sets = await api.properties.getPropertySets(model, id, true);
    const quantities = sets.find((s) => s.Name?.value === 'Hoist_Quantities');
    const weight = quantities?.Quantities?.find((q) => q.Name.value === 'GrossWeight');
    check(Math.abs(weight?.WeightValue?.value - thing.weight) < 1e-6, `${where}: weight`);
    const recognition = sets.find((s) => s.Name?.value === 'Hoist_Recognition');
    const score = recognition?.HasProperties?.find((p) => p.Name.value === 'Score');
    check(score?.NominalValue?.value === 0.5, `${where}: property set`);
    const materials = await api.properties.getMaterialsProperties(model, id, true);
    check(materials.length === 1 && materials[0].Name?.value === thing.material,
          `${where}: material ${materials[0]?.Name?.value}`);
  }
  api.CloseModel(model);

  const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
  const store = await new IfcParser().parseColumnar(buffer);
  check(store.entityCount === instances(text).size,
        `${file}: ifc-lite finds ${store.entityCount} instances`);
  say(`${file}: ${expected.things.length} things, corners within ${worst} m`);
}

for (const expected of JSON.parse(fs.readFileSync(path.join(folder, 'expected.json'))))
  await checkModel(expected);
for (const failure of failures.slice(0, 40)) console.error(failure);
say(`${checks} checks, ${failures.length} failed`);
process.exit(failures.length === 0 && checks > 1000 ? 0 : 1);
