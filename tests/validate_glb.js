// Prints what Khronos' validator says of each GLB file that is named: one JSON object, by file.
const fs = require("fs");
const validator = require("gltf-validator");

(async () => {
  const found = {};
  for (const file of process.argv.slice(2)) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), { format: "glb", maxIssues: 0 });
    found[file] = report.issues.messages.map(
      (issue) => `${["error", "warning", "information", "hint"][issue.severity]} ${issue.code} ${issue.pointer || ""}: ${issue.message}`,
    );
  }
  console.log(JSON.stringify(found));
})();
