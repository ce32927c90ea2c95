// Tasks: `staunch check` and `staunch test`, with what they report as problems.

const path = require("node:path");
const vscode = require("vscode");
const command = require("./command");

function task(folder, definition) {
    const args = [definition.command, "--message-format", "short", ...command.common(folder.uri), ...(definition.arguments ?? [])];
    // `short` is for diagnostics; the results of tests are read by people.
    if (definition.command === "test") args.splice(1, 2);
    const name = [definition.command, ...(definition.arguments ?? [])].join(" ");
    const execution = new vscode.ProcessExecution(command.executable(folder.uri), args, { cwd: folder.uri.fsPath });
    const made = new vscode.Task(definition, folder, name, "staunch", execution, "$staunch");
    made.group = definition.command === "test" ? vscode.TaskGroup.Test : vscode.TaskGroup.Build;
    return made;
}

async function ofFolder(folder) {
    const has = await command.project(folder.uri.fsPath);
    const all = has ? [] : ["."];
    const made = ["check", "test"].map((it) => task(folder, { type: "staunch", command: it, arguments: all }));
    const open = vscode.window.activeTextEditor?.document;
    if (!has && open?.languageId === "iecst" && vscode.workspace.getWorkspaceFolder(open.uri) === folder) {
        const file = path.relative(folder.uri.fsPath, open.uri.fsPath);
        made.push(task(folder, { type: "staunch", command: "check", arguments: [file] }));
    }
    return made;
}

const provider = {
    async provideTasks() {
        const folders = (vscode.workspace.workspaceFolders ?? []).filter((it) => it.uri.scheme === "file");
        return (await Promise.all(folders.map(ofFolder))).flat();
    },
    // One of `tasks.json`.
    resolveTask(given) {
        const folder = typeof given.scope === "object" ? given.scope : vscode.workspace.workspaceFolders?.[0];
        return folder && given.definition.command ? task(folder, given.definition) : undefined;
    },
};

module.exports = { provider };
