#!/usr/bin/env python3
"""An object store for tests: the part of S3 that Vantage uses, and plain files of the web.

usage: object_server.py FOLDER [SECONDS]

Serves the files of FOLDER as bucket `data`, on a free port of 127.0.0.1, and prints its address; ends
after SECONDS (600). As a module: ObjectServer, with what it was asked and faults on demand.

It verifies what a client signs (AWS Signature Version 4, written from AWS's documentation) and every
checksum; it knows ranges, If-Match, If-None-Match, uploads in parts and listings in small pages.
"""

import base64
import binascii
import datetime
import email.utils
import hashlib
import hmac
import random
import ssl
import sys
import threading
import time
import urllib.parse
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from xml.sax.saxutils import escape

KEY_ID, SECRET, REGION = "TESTKEY", "test/secret+key", "eu-test-1"


class Faults:
    """What goes wrong on purpose; all off at first."""

    def __init__(self):
        self.busy_share = 0.0  # of requests that are answered with 503
        self.retry_after = None  # seconds that those ask for
        self.cut_share = 0.0  # of bodies that end early
        self.silent = None  # paths with this text are not answered
        self.slow_bytes_per_s = None
        self.lost_answers = 0  # so many puts are done and not answered
        self.no_ranges = False
        self.clock_skew = False
        self.replace_after = None  # (key, gets, other, content): put at `other` after so many GETs
        self.random = random.Random(47)


class StoredObject:
    def __init__(self, content, checksum=None):
        self.content = content
        self.etag = f'"{hashlib.md5(content).hexdigest()}"'
        self.checksum = checksum
        self.modified = email.utils.formatdate(usegmt=True)


class Refused(Exception):
    def __init__(self, status, code, extra="", headers=()):
        super().__init__(code)
        self.status, self.code, self.extra, self.headers = status, code, extra, headers


def crc32_base64(content):
    return base64.b64encode(binascii.crc32(content).to_bytes(4, "big")).decode()


def quoted(text, safe=""):
    return urllib.parse.quote(text, safe="-_.~" + safe)


class ObjectServer:
    """`buckets`: {name: {key: StoredObject}}. `requests`: (method, path, headers) in their order.
    `certificate`: a PEM file with its key, for https."""

    def __init__(self, page_keys=3, session_token=None, certificate=None):
        self.buckets = {"data": {}}
        self.requests = []
        self.faults = Faults()
        self.uploads = {}
        self.moved_to = None  # where /moved/ is redirected to
        self.page_keys = page_keys
        self.session_token = session_token
        self.lock = threading.Lock()
        self.ending = threading.Event()
        store = self

        class Handler(RequestHandler):
            server_store = store

        class Server(ThreadingHTTPServer):
            daemon_threads = True
            request_queue_size = 128  # clients read ahead: many connect at a time

            def handle_error(self, request, client_address):
                pass  # clients that end early

        self.server = Server(("127.0.0.1", 0), Handler)
        self.url = f"http://127.0.0.1:{self.server.server_port}"
        if certificate is not None:
            context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
            context.load_cert_chain(certificate)
            self.server.socket = context.wrap_socket(self.server.socket, server_side=True)
            self.url = self.url.replace("http", "https")
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self.ending.set()
        self.server.shutdown()
        self.server.server_close()

    def put(self, key, content, bucket="data"):
        self.buckets[bucket][key] = StoredObject(content)

    def add_folder(self, folder, prefix=""):
        for file in sorted(Path(folder).rglob("*")):
            if file.is_file():
                self.put(prefix + file.relative_to(folder).as_posix(), file.read_bytes())

    def environment(self):
        """Variables with which a client reaches this store, and no other."""
        return {"AWS_ENDPOINT_URL": self.url, "AWS_ACCESS_KEY_ID": KEY_ID,
                "AWS_SECRET_ACCESS_KEY": SECRET, "AWS_REGION": REGION,
                "AWS_EC2_METADATA_DISABLED": "true", "AWS_CONFIG_FILE": "/dev/null",
                "AWS_SHARED_CREDENTIALS_FILE": "/dev/null", "no_proxy": "*"}


class RequestHandler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    server_store = None
    timeout = 60
    wbufsize = 1 << 16  # headers and body in one packet: no waiting for acknowledgements
    disable_nagle_algorithm = True

    def log_message(self, *_):
        pass

    def answer(self, status, body=b"", headers=()):
        faults = self.server_store.faults
        self.send_response(status)
        names = {name.lower() for name, _ in headers}
        for name, value in headers:
            self.send_header(name, value)
        if "content-length" not in names:
            self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        if self.command == "HEAD":
            return
        if len(body) > 100 and faults.random.random() < faults.cut_share:
            body = body[:len(body) // 2]
            self.close_connection = True
        if faults.slow_bytes_per_s:
            for begin in range(0, len(body), max(1, faults.slow_bytes_per_s // 10)):
                self.wfile.write(body[begin:begin + max(1, faults.slow_bytes_per_s // 10)])
                self.wfile.flush()
                if self.server_store.ending.wait(0.1):
                    return
        else:
            self.wfile.write(body)

    def refuse(self, refused):
        body = (f'<?xml version="1.0" encoding="UTF-8"?>\n<Error><Code>{refused.code}</Code>'
                f"<Message>{refused.code} &amp; more</Message>{refused.extra}</Error>").encode()
        self.answer(refused.status, body, refused.headers)

    def handle_any(self):
        store = self.server_store
        faults = store.faults
        body = self.rfile.read(int(self.headers.get("Content-Length", 0)))
        with store.lock:
            store.requests.append((self.command, self.path, dict(self.headers)))
            is_busy = faults.random.random() < faults.busy_share
        if faults.silent is not None and faults.silent in self.path:
            store.ending.wait(60)
            self.close_connection = True
            return
        if is_busy:
            asked = [] if faults.retry_after is None else [("Retry-After", str(faults.retry_after))]
            self.answer(503, b"<Error><Code>SlowDown</Code></Error>", asked)
            return
        try:
            path, _, query = self.path.partition("?")
            if path.startswith("/web/"):
                self.get_object(store.buckets["data"], urllib.parse.unquote(path[5:]))
            elif path.startswith("/moved/"):
                self.answer(302, headers=[("Location", store.moved_to + path[6:])])
            elif path.startswith("/page/"):
                self.answer(404, b"<html>Not found</html>")
            else:
                self.verify(path, query, body)
                self.serve(path, dict(urllib.parse.parse_qsl(query, keep_blank_values=True)), body)
        except Refused as refused:
            self.refuse(refused)

    do_GET = do_HEAD = do_PUT = do_POST = do_DELETE = handle_any

    def verify(self, path, query, body):
        """AWS Signature Version 4, as "Signature calculations" of the S3 API reference has it."""
        header = self.headers.get("Authorization")
        if header is None:
            if path.startswith("/public/"):
                return
            raise Refused(403, "AccessDenied")
        fields = dict(part.strip().split("=", 1) for part in header.split(" ", 1)[1].split(","))
        key_id, day, region, service, ending = fields["Credential"].split("/")
        if key_id != KEY_ID:
            raise Refused(403, "InvalidAccessKeyId")
        if (service, ending) != ("s3", "aws4_request"):
            raise Refused(400, "AuthorizationQueryParametersError")
        if region != REGION:
            raise Refused(400, "AuthorizationHeaderMalformed", f"<Region>{REGION}</Region>")
        names = fields["SignedHeaders"].split(";")
        sent = {name.lower() for name in self.headers if name.lower().startswith("x-amz-")}
        if not ({"host"} | sent) <= set(names) or names != sorted(names):
            raise Refused(403, "AccessDenied", "<Reason>headers that are not signed</Reason>")
        if self.server_store.session_token != self.headers.get("x-amz-security-token"):
            raise Refused(403, "InvalidToken")
        moment = self.headers["x-amz-date"]
        sent_at = datetime.datetime.strptime(moment, "%Y%m%dT%H%M%SZ")
        off = abs((sent_at - datetime.datetime.utcnow()).total_seconds())
        if self.server_store.faults.clock_skew:
            later = time.time() + 3600
            raise Refused(403, "RequestTimeTooSkewed", headers=[
                ("Date", email.utils.formatdate(later, usegmt=True))])
        if off > 900:
            raise Refused(403, "RequestTimeTooSkewed")
        content = self.headers["x-amz-content-sha256"]
        if content != hashlib.sha256(body).hexdigest():
            raise Refused(400, "XAmzContentSHA256Mismatch")
        pairs = [part.partition("=") for part in query.split("&") if part]
        encoded = sorted((quoted(urllib.parse.unquote(name)), quoted(urllib.parse.unquote(value)))
                         for name, _, value in pairs)
        canonical = "\n".join([
            self.command, quoted(urllib.parse.unquote(path), "/"),
            "&".join(f"{name}={value}" for name, value in encoded),
            "".join(f"{name}:{' '.join(self.headers[name].split())}\n" for name in names),
            ";".join(names), content])
        text = "\n".join(["AWS4-HMAC-SHA256", moment, f"{day}/{region}/s3/aws4_request",
                          hashlib.sha256(canonical.encode()).hexdigest()])
        key = ("AWS4" + SECRET).encode()
        for step in (day, region, "s3", "aws4_request"):
            key = hmac.digest(key, step.encode(), "sha256")
        if hmac.digest(key, text.encode(), "sha256").hex() != fields["Signature"]:
            raise Refused(403, "SignatureDoesNotMatch")

    def serve(self, path, query, body):
        store = self.server_store
        bucket_name, _, key = urllib.parse.unquote(path[1:]).partition("/")
        bucket = store.buckets.get(bucket_name)
        if bucket is None:
            raise Refused(404, "NoSuchBucket")
        if self.command in ("GET", "HEAD") and not key:
            self.list_objects(bucket, query)
        elif self.command in ("GET", "HEAD"):
            self.get_object(bucket, key)
        elif self.command == "DELETE":
            (store.uploads.pop(query["uploadId"], None) if "uploadId" in query
             else bucket.pop(key, None))
            self.answer(204)
        elif "uploads" in query:
            upload = f"upload/{len(store.uploads)}+1"
            store.uploads[upload] = {}
            self.answer(200, f"<InitiateMultipartUploadResult><UploadId>{upload}</UploadId>"
                             f"</InitiateMultipartUploadResult>".encode())
        elif "partNumber" in query:
            self.verify_checksum(body)
            part = StoredObject(body)
            store.uploads[query["uploadId"]][int(query["partNumber"])] = part
            self.answer(200, headers=[("ETag", part.etag)])
        else:
            self.put_object(bucket, key, query, body)

    def verify_checksum(self, body):
        checksum = self.headers.get("x-amz-checksum-crc32")
        if checksum is None:
            raise Refused(400, "MissingChecksum")  # S3 takes such puts; ours shall have one
        if checksum != crc32_base64(body):
            raise Refused(400, "BadDigest")
        return checksum

    def put_object(self, bucket, key, query, body):
        store = self.server_store
        if "uploadId" in query:
            parts = store.uploads[query["uploadId"]]
            for number, part in parts.items():
                entry = (f"<Part><PartNumber>{number}</PartNumber><ETag>{escape(part.etag)}</ETag>"
                         f"<ChecksumCRC32>{crc32_base64(part.content)}</ChecksumCRC32></Part>")
                if entry not in body.decode().replace("&quot;", '"'):
                    raise Refused(400, "InvalidPart")
            stored = StoredObject(b"".join(parts[number].content for number in sorted(parts)),
                                  f"{len(parts)} parts")
        else:
            stored = StoredObject(body, self.verify_checksum(body))
        with store.lock:
            present = bucket.get(key)
            if "If-Match" in self.headers and present is None:
                raise Refused(404, "NoSuchKey")
            if ((self.headers.get("If-None-Match") == "*" and present is not None) or
                    self.headers.get("If-Match", present and present.etag) !=
                    (present and present.etag)):
                raise Refused(412, "PreconditionFailed")
            bucket[key] = stored
            is_lost = store.faults.lost_answers > 0
            store.faults.lost_answers -= is_lost
        store.uploads.pop(query.get("uploadId"), None)
        if is_lost:
            self.close_connection = True
            return
        xml = f"<CompleteMultipartUploadResult><ETag>{escape(stored.etag)}</ETag></Complete>"
        self.answer(200, xml.encode() if "uploadId" in query else b"", [("ETag", stored.etag)])

    def get_object(self, bucket, key):
        faults = self.server_store.faults
        found = bucket.get(key)
        if found is None:
            raise Refused(404, "NoSuchKey")
        if self.headers.get("If-Match", found.etag) != found.etag:
            raise Refused(412, "PreconditionFailed")
        headers = [("ETag", found.etag), ("Last-Modified", found.modified)]
        content = found.content
        if faults.replace_after and faults.replace_after[0] == key and self.command == "GET":
            name, gets, other, replacement = faults.replace_after
            faults.replace_after = (name, gets - 1, other, replacement) if gets > 1 else None
            if gets <= 1:
                self.server_store.put(other, replacement)
        if self.command == "HEAD":
            self.answer(200, headers=[*headers, ("Content-Length", str(len(content)))])
        elif "Range" in self.headers and not faults.no_ranges:
            first, last = self.headers["Range"].removeprefix("bytes=").split("-")
            begin, end = int(first), min(int(last) + 1, len(content))
            if begin >= len(content):
                raise Refused(416, "InvalidRange")
            span = f"bytes {begin}-{end - 1}/{len(content)}"
            self.answer(206, content[begin:end], [*headers, ("Content-Range", span)])
        else:
            self.answer(200, content, headers)

    def list_objects(self, bucket, query):
        if query.get("list-type") != "2":
            raise Refused(400, "InvalidArgument")
        prefix, delimiter = query.get("prefix", ""), query.get("delimiter")
        entries = {}
        for key in sorted(bucket, key=lambda text: text.encode()):
            if key.startswith(prefix):
                rest = key[len(prefix):]
                is_folder = delimiter is not None and delimiter in rest
                entries[prefix + rest.split(delimiter)[0] + delimiter if is_folder else key] = (
                    None if is_folder else bucket[key])
        names = [name for name in entries if name > query.get("continuation-token", "")[6:]]
        page = names[:min(self.server_store.page_keys, int(query.get("max-keys", 1000)))]
        is_encoded = query.get("encoding-type") == "url"

        def shown(key):
            return urllib.parse.quote_plus(key, safe="/") if is_encoded else escape(key)

        xml = ["<ListBucketResult>", "<EncodingType>url</EncodingType>" if is_encoded else ""]
        for name in page:
            found = entries[name]
            if found is None:
                xml.append(f"<CommonPrefixes><Prefix>{shown(name)}</Prefix></CommonPrefixes>")
            else:
                etag = found.etag.replace('"', "&quot;")
                xml.append(f"<Contents><Key>{shown(name)}</Key><LastModified>2026-11-28T00:00:00Z"
                           f"</LastModified><ETag>{etag}</ETag><Size>{len(found.content)}</Size>"
                           "</Contents>")
        is_last = len(page) == len(names)
        xml.append(f"<IsTruncated>{'false' if is_last else 'true'}</IsTruncated>")
        if not is_last:
            token = escape("token+" + page[-1])
            xml.append(f"<NextContinuationToken>{token}</NextContinuationToken>")
        self.answer(200, ("".join(xml) + "</ListBucketResult>").encode())


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    with ObjectServer(page_keys=1000) as server:
        server.add_folder(sys.argv[1])
        print(server.url, flush=True)
        time.sleep(float(sys.argv[2]) if len(sys.argv) == 3 else 600)


if __name__ == "__main__":
    main()
