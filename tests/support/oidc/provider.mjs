// OpenID Connect provider for tests: node provider.mjs PORT CLIENT_SECRET REDIRECT_URI
// Prints a line when it serves http://127.0.0.1:PORT, with a form that lets any name log in, until its standard input ends.
import Provider from 'oidc-provider';

const [port, secret, redirect] = process.argv.slice(2);
const provider = new Provider(`http://127.0.0.1:${port}`, {
  clients: [{ client_id: 'macadam', client_secret: secret, redirect_uris: [redirect], response_types: ['code'], grant_types: ['authorization_code'] }],
  claims: { openid: ['sub'] },
  findAccount: (_, id) => ({ accountId: id, claims: () => ({ sub: id }) }),
  cookies: { keys: [secret] },
  pkce: { required: () => true },
});
provider.listen(Number(port), '127.0.0.1', () => console.log('ready'));
process.stdin.on('end', () => process.exit(0)).resume();
