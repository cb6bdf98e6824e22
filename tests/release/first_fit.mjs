// What someone does first with the npm package, beside whose node_modules this lies: fits a paint in Node, compares the
// model with it and keeps the model's file.
import {readFileSync} from "node:fs";

import {open} from "burnish";

const paint = await open("ggx:alpha_x=0.2,alpha_y=0.2,f0=0.8/0.4/0.2,kd=0.1");
const model = await paint.fit({budget: 2700});
const [figures] = await paint.compare(model);
const bytes = await model.export("burnish");
const again = await open(bytes);
const [copied] = await paint.compare(again);
const {version} = JSON.parse(readFileSync(new URL("node_modules/burnish/package.json", import.meta.url)));
console.log(`burnish ${version}: psnr of the first fit ${figures.psnr.toFixed(2)} dB, ${bytes.length} bytes`);
if (!(figures.psnr > 40) || copied.psnr !== figures.psnr) throw new Error("a poorer fit than it should be");
for (const each of [paint, model, again]) each.close();
