// S3-compatible service for tests: node server.mjs FOLDER [--failing N [--status N]] [--tls]
// Prints its port, and serves bucket "roads" until its standard input ends. --failing: the first N
// requests are answered by 503, or another --status; --tls: with FOLDER/key.pem and FOLDER/cert.pem.
import {createHash, randomUUID} from "node:crypto";
import {readFileSync} from "node:fs";
import {mkdir, rename, writeFile} from "node:fs/promises";
import http from "node:http";
import https from "node:https";
import {dirname, join} from "node:path";
import {buffer} from "node:stream/consumers";
import {parseArgs} from "node:util";
import S3rver from "s3rver";

const {values, positionals: [folder]} = parseArgs({
    options: {failing: {type: "string", default: "0"}, status: {type: "string", default: "503"}, tls: {type: "boolean", default: false}},
    allowPositionals: true,
});
const service = new S3rver({directory: join(folder, "buckets"), silent: true, configureBuckets: [{name: "roads"}]});
await service.configureBuckets();
keepWhatIsAcknowledged(service.store);
const answer = service.callback();
let failing = Number(values.failing);
const listener = (request, response) => {
    if (failing > 0) {
        --failing;
        request.resume();
        response.writeHead(Number(values.status), {"Content-Type": "application/xml"});
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

// s3rver answers a PUT before the file is written, and a GET with the length of one version and the content of another.
function keepWhatIsAcknowledged(store) {
    let before = Promise.resolve();
    const inTurn = (work) => (...values) => {
        const now = before.then(() => work(...values));
        before = now.catch(() => {});
        return now;
    };
    for (const name of ["getObject", "copyObject", "deleteObject", "listObjects"]) {
        store[name] = inTurn(store[name].bind(store));
    }
    const write = inTurn(async ({bucket, key, metadata}, content) => {
        const path = store.getResourcePath(bucket, key, "object");
        const written = `${path}.${randomUUID()}`;
        const md5 = createHash("md5").update(content).digest("hex");
        await mkdir(dirname(path), {recursive: true});
        await writeFile(written, content);
        await rename(written, path);
        await store.putMetadata(bucket, key, metadata, md5);
        return {size: content.length, md5};
    });
    store.putObject = async (object) => write(object, Buffer.isBuffer(object.content) ? object.content : await buffer(object.content));
}
