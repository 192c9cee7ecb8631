// Prints what the Khronos validator finds in each file given, as one JSON list of messages per line.
const fs = require("fs");
const validator = require(process.argv[2]);
(async () => {
  for (const path of process.argv.slice(3)) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(path)), { maxIssues: 100 });
    console.log(JSON.stringify(report.issues.messages));
  }
})();
