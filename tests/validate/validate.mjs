// SPDX-License-Identifier: MIT
// Checks glTF files with the Khronos validator: node validate.mjs [--json] FILE...
// Prints the errors of each file; exits 1 when there is any, 2 when a file cannot be read. With --json, prints one object:
// file name -> {errors, warnings, infos, codes: {code: count}}.
import { readFile } from 'node:fs/promises';
import { dirname, resolve } from 'node:path';
import validator from 'gltf-validator';

const options = process.argv.slice(2).filter((a) => a.startsWith('--'));
const files = process.argv.slice(2).filter((a) => !a.startsWith('--'));
if (files.length === 0 || options.some((o) => o !== '--json')) {
  console.error('usage: node validate.mjs [--json] FILE...');
  process.exit(2);
}

const severities = ['error', 'warning', 'info', 'hint'];
const summary = {};
let failed = false;
for (const file of files) {
  let report;
  try {
    report = await validator.validateBytes(new Uint8Array(await readFile(file)), {
      uri: file,
      maxIssues: 0,
      externalResourceFunction: async (uri) =>
        new Uint8Array(await readFile(resolve(dirname(file), decodeURIComponent(uri)))),
    });
  } catch (error) {
    console.error(`${file}: ${error.message ?? error}`);
    process.exitCode = 2;
    continue;
  }
  const { numErrors, numWarnings, numInfos, messages } = report.issues;
  const codes = {};
  for (const { code, severity } of messages) {
    const key = `${severities[severity]} ${code}`;
    codes[key] = (codes[key] ?? 0) + 1;
  }
  summary[file] = { errors: numErrors, warnings: numWarnings, infos: numInfos, codes };
  failed ||= numErrors > 0;
  if (options.length > 0) continue;
  const errors = messages.filter((m) => m.severity === 0);
  for (const m of errors.slice(0, 20)) console.error(`${file}: ${m.pointer ?? ''} ${m.code}: ${m.message}`);
  if (errors.length > 20) console.error(`${file}: and ${errors.length - 20} more errors`);
  console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings`);
}
if (options.length > 0) console.log(JSON.stringify(summary, null, 1));
if (failed) process.exitCode = 1;
