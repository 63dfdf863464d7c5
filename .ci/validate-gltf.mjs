// Validates glTF files with the Khronos validator.
//
//     npm ci --prefix .ci
//     node .ci/validate-gltf.mjs FILE...
//
// Prints one line a file. Exits with 1 where a file has errors or warnings or cannot be read, with 2 where none is given.

import { readFile } from "node:fs/promises";
import { dirname, resolve } from "node:path";
import validator from "gltf-validator";

const files = process.argv.slice(2);
if (files.length === 0) {
  console.error("usage: node .ci/validate-gltf.mjs FILE...");
  process.exit(2);
}

let sound = true;
for (const file of files) {
  try {
    const report = await validator.validateBytes(new Uint8Array(await readFile(file)), {
      uri: file,
      externalResourceFunction: async (uri) =>
        new Uint8Array(await readFile(resolve(dirname(file), decodeURIComponent(uri)))),
    });
    const { numErrors, numWarnings, numInfos, numHints, messages } = report.issues;
    console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos, ${numHints} hints`);
    // Severity 0 is an error, 1 a warning.
    for (const { code, message, pointer } of messages.filter(({ severity }) => severity <= 1).slice(0, 20)) {
      console.error(`  ${code} at ${pointer ?? "the file"}: ${message}`);
    }
    if (numErrors + numWarnings > 0) sound = false;
  } catch (error) {
    console.log(`${file}: cannot be validated: ${error.message ?? error}`);
    sound = false;
  }
}
process.exit(sound ? 0 : 1);
