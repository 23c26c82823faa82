// S3-compatible service for tests: node server.mjs FOLDER [--failing N] [--tls]
// Prints its port, and serves bucket "roads" until its standard input ends. --failing: the first N
// requests are answered by 503; --tls: with FOLDER/key.pem and FOLDER/cert.pem.
import http from "node:http";
import https from "node:https";
import {readFileSync} from "node:fs";
import {join} from "node:path";
import {parseArgs} from "node:util";
import S3rver from "s3rver";

const {values, positionals: [folder]} = parseArgs({
    options: {failing: {type: "string", default: "0"}, tls: {type: "boolean", default: false}},
    allowPositionals: true,
});
const service = new S3rver({directory: join(folder, "buckets"), silent: true, configureBuckets: [{name: "roads"}]});
await service.configureBuckets();
const answer = service.callback();
let failing = Number(values.failing);
const listener = (request, response) => {
    if (failing > 0) {
        --failing;
        request.resume();
        response.writeHead(503, {"Content-Type": "application/xml"});
        response.end("<Error><Code>SlowDown</Code><Message>Please reduce your request rate.</Message></Error>");
    } else {
        answer(request, response);
    }
};
const server = values.tls
    ? https.createServer({key: readFileSync(join(folder, "key.pem")), cert: readFileSync(join(folder, "cert.pem"))}, listener)
    : http.createServer(listener);
server.listen(0, "127.0.0.1", () => console.log(server.address().port));
process.stdin.resume();
process.stdin.on("end", () => process.exit(0));
